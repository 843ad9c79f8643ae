#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/pipeline/bundle_problem.hpp"

namespace roadbook {

// The value of each session of a map to the others: by how much its observations and loops lowered
// their standard deviations.

/// A point that moves with a keyframe, such as the middle of a label.
struct AnchoredPoint {
  int keyframe = 0;
  Eigen::Vector3d p_vehicle = Eigen::Vector3d::Zero();  ///< [m], in the keyframe's vehicle frame
};

/// Standard deviations of positions [m], the root of the trace, with and without a session.
struct SigmaChange {
  std::size_t count = 0;  ///< positions compared; 0: the others are not set
  double with_m = 0.0;
  double without_m = 0.0;

  [[nodiscard]] double gain_m() const { return without_m - with_m; }
};

/// Worth of a session to the other sessions.
struct SessionValue {
  int session = 0;
  SigmaChange poses;      ///< means over the keyframes of the other sessions that take part
  SigmaChange points;     ///< means over the anchored points of the other sessions
  SigmaChange landmarks;  ///< medians over landmarks that other sessions see, given the poses
  int pieces_more = 0;    ///< pieces that the map has more without the session
};

struct SessionValueOptions {
  /// Of larger maps every n-th keyframe of each session takes part, with n times the information of
  /// its observations: the cost grows with the third power of their number.
  std::size_t most_keyframes = 240;
  BundleStageOptions bundle;

  /// Throws InvalidOption.
  void check() const;
};

/// The value of each session, in the order of the map; empty for a map of one session.
///
/// Covariances of poses are exact marginals at the map's state, relative to the first keyframe of
/// the piece that another session drove. They count observations, wheels, and accepted loops whose
/// two images share fewer than ten landmarks: where they share more, the observations say what
/// the loop says. All errors count as independent, so that standard deviations are smaller than
/// those that the map stores; compare them with each other. A prior of 10 m and 1 rad on each pose
/// bounds them where only the session joins a place to the rest. Landmarks without three views of
/// other sessions do not count.
///
/// The same bytes on any number of threads. If the map leaves no covariance, poses and points have
/// a count of 0.
[[nodiscard]] std::vector<SessionValue> session_values(const Map& map,
                                                       const std::vector<AnchoredPoint>& points,
                                                       const SessionValueOptions& options = {});

}  // namespace roadbook
