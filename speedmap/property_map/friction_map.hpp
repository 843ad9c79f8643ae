#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "speedmap/property_map/lane_strips.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

/// Position of a knot's ground relative to the vehicle that passed it. It stays right when the map
/// is optimised again, because it follows the vehicle's pose of that moment.
struct KnotAnchor {
  std::string session;  ///< its name; empty: no vehicle was near
  std::int64_t t_ns = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< [m] ahead of the rear axle, to the left
};

/// What became of a friction map whose paths have moved.
struct FrictionCarry {
  bool moved = false;             ///< the paths are others than those it was stored with
  std::size_t dropped = 0;        ///< knots that lie on no path any more
  double evidence_dropped = 0.0;  ///< labels that they had seen
  double evidence = 0.0;          ///< labels seen by all knots that are left
};

/// A friction map as a map file keeps it: reads back to the same numbers, and can be extended. Its
/// first property is friction; there may be further ones.
struct FrictionMap {
  LaneStrips strips;
  PropertyMap map;
  double spacing_m = 1.0;  ///< of the knots
  double kernel_width_m = 2.0;
  std::int64_t date_ns = 0;           ///< of the newest measurement
  std::vector<std::string> sessions;  ///< names of those that were used
  FrictionCarry carry;
  std::string paths;                ///< `paths_digest` of the paths that it lies on
  std::vector<KnotAnchor> anchors;  ///< one a knot, or none where poses are not known
  std::string config;               ///< text of the configuration that it was begun with
};

}  // namespace roadbook
