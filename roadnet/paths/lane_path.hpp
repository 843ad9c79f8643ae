#pragma once

#include <cstdint>
#include <vector>

#include "roadnet/network.hpp"
#include "roadnet/paths/bezier_path.hpp"

namespace roadbook {

// The lanes of a road network as paths: centre lines with continuous curvature, their distance from
// the driven positions, their curvature and their width.
//
// The polyline of a lane shows its topology, but its corners are a metre off and have kinks. So the
// path is fitted to the driven positions themselves. They are assigned along the polyline first,
// and then by projection on the path. Positions near intersections, where vehicles turn, do not
// count: the path continues smoothly to the intersection, where lanes meet.

struct LanePathOptions {
  double max_deviation_m = 0.2;  ///< smoothing is weakened until the path is this near
  /// Oscillations of this wavelength are halved (PathFitOptions). A quarter turn of 5 m radius is a
  /// quarter of a wave of 30 m; much shorter ones are scatter of the passes.
  double smooth_below_m = 10.0;
  double least_smooth_m = 3.0;   ///< lower bound of the weakened wavelength
  double tightest_turn = 0.5;    ///< [1/m]; smoothing is not weakened to a curvature above this
  double segment_m = 4.0;        ///< length of a segment; the smoothing decides the shape
  double junction_m = 6.0;       ///< positions nearer to an intersection do not count
  double vehicle_width_m = 1.9;  ///< of the recording vehicle, if the map does not know it
  double widest_tube_m = 5.0;    ///< upper bound of `tube_m`
  int degree = 6;

  /// Throws InvalidOption.
  void check() const;
};

enum class LanePathStatus : std::uint8_t {
  kOk,
  kDeviates,    ///< farther from the driven positions than `max_deviation_m`
  kDegenerate,  ///< the lane has no length: no path
};
[[nodiscard]] const char* to_text(LanePathStatus status);

struct LanePath {
  std::uint64_t lane = 0;  ///< id of the lane; the path runs first to last point of its centre
  LanePathStatus status = LanePathStatus::kOk;
  BezierPath path;
  double length_m = 0.0;
  /// Largest distance of the path from the mean of the driven positions, over stretches of 1 m;
  /// away from intersections.
  double deviation_m = 0.0;
  double deviation_s_m = 0.0;      ///< s of this deviation
  double max_curvature = 0.0;      ///< [1/m], absolute
  double max_curvature_s_m = 0.0;  ///< s of this curvature
  /// Width that the vehicle swept in 95 % of the passes: its own width plus four standard
  /// deviations of the positions. It is the driven width, not the free width.
  double width_m = 0.0;
  /// Half width of the tube in which path coordinates are unique [SPM, lemma 1], at most
  /// `widest_tube_m`.
  double tube_m = 0.0;
};

/// Fits one path to each lane, in the order of the lanes. Lanes that meet share the end of their
/// paths; a ring is a closed path. `passes`: those that the network was built from. Deterministic
/// for any number of threads.
///
/// Throws InvalidOption, and BadInput for positions that are not finite.
[[nodiscard]] std::vector<LanePath> lane_paths(const RoadNetwork& network,
                                               const std::vector<DrivenPass>& passes,
                                               const LanePathOptions& options = {},
                                               int num_threads = 1);

}  // namespace roadbook
