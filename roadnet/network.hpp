#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace roadbook {

// The road network: lanes between intersections, found from driven positions only.

/// One pass of the vehicle: positions in driving order [m, map frame]. A new pass begins where a
/// session begins, after a gap, and where the driving direction changes.
struct DrivenPass {
  int session = 0;
  bool reversing = false;
  std::vector<Eigen::Vector3d> positions;
};

struct Intersection {
  std::uint64_t id = 0;  ///< derived from its position, and kept when the map is updated
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

struct Lane {
  std::uint64_t id = 0;  ///< kept when the map is updated
  std::vector<Eigen::Vector3d>
      centre;                  ///< polyline [m]; first and last on intersections where joined
  int from_intersection = -1;  ///< index, -1: dead end
  int to_intersection = -1;
  bool closed = false;      ///< a ring without intersection
  int forward_passes = 0;   ///< driven first to last
  int backward_passes = 0;  ///< driven last to first
  int reverse_gear_passes = 0;
  double length_m = 0.0;
  double width_m = 0.0;  ///< holds 95 % of the driven positions: four standard deviations
  [[nodiscard]] bool one_way() const { return forward_passes == 0 || backward_passes == 0; }
};

/// A driven stretch that the network does not cover. `from` and `to` are the ends of the longest
/// uncovered part of a pass [m, map frame].
struct UncoveredStretch {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double driven_m = 0.0;  ///< length of all uncovered parts there
  int parts = 0;          ///< number of uncovered parts of passes there
};

enum class RoadNetworkStatus {
  kOk,
  kEmpty,        ///< nothing was driven
  kLowCoverage,  ///< too many driven positions are off the network: do not use it
};

struct RoadNetwork {
  RoadNetworkStatus status = RoadNetworkStatus::kOk;
  std::vector<Intersection> intersections;
  std::vector<Lane> lanes;
  double length_m = 0.0;
  double coverage = 0.0;  ///< fraction of driven positions within reach of the network
  std::vector<UncoveredStretch> uncovered;  ///< where the coverage is below 0.99; longest driven
                                            ///< first
  double reach_m = 0.0;                     ///< cover radius used
  int cycle_rank = 0;                       ///< independent loops
  int components = 0;
};

}  // namespace roadbook
