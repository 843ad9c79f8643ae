#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

// Joined tracks whose views do not show one corner.
//
// A match between two passes decides by descriptors and a search window. Where corners look alike,
// such as the slots of a grid or two cars of one make, it joins tracks of different corners, and
// the union of matches carries one wrong match to all their views. With adjusted poses the views
// themselves tell: each odometry track alone fits a position well, all together fit none.

struct AgreementOptions {
  /// Standard deviation of a key point [px, half-size image, per coordinate].
  double sigma_px = 0.6;
  /// Squared residual, normalised by `sigma_px`, beyond which a view or a track disagrees: 2
  /// degrees of freedom, p = 1e-4.
  double max_chi2 = 18.4;
  TriangulationOptions triangulation;
  int num_threads = 0;
};

/// Standard deviation per coordinate of key points whose residuals have the median length
/// `median_px`, at least 0.1 px. Outliers do not change the median much.
[[nodiscard]] double sigma_of_median_px(double median_px);

/// What `split_disagreeing_tracks` did.
struct AgreementCounts {
  std::size_t split = 0;          ///< joined tracks that became two or more
  std::size_t views_dropped = 0;  ///< of corners in several sessions, that fit no position
};

/// Splits joined tracks whose odometry tracks contradict each other, given the poses.
///
/// The odometry tracks that agree with one position stay together. An odometry track agrees if its
/// root mean square residual at that position exceeds the one at its own best position by less than
/// the gate, so that errors of a camera's calibration, which all its views share, split nothing.
/// The first corner stays at its index with its new `p_map`; further ones are appended. Of a corner
/// seen in several sessions, views beyond the gate are dropped. Tracks of one odometry track, and
/// those that agree, are left as they are. Deterministic on any number of threads.
AgreementCounts split_disagreeing_tracks(const MappingInput& input,
                                         const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                         const AgreementOptions& options,
                                         std::vector<JoinedTrack>& tracks);

}  // namespace roadbook
