#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "speedmap/property_map/lane_strips.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

/// The position of a knot's ground relative to a vehicle pose that passed it. It stays valid when
/// the map is optimised again.
struct KnotAnchor {
  std::string session;  ///< its name; empty: no vehicle was near
  std::int64_t t_ns = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< [m] ahead of the rear axle, to the left
};

/// How a friction map was moved to changed paths.
struct FrictionCarry {
  bool moved = false;             ///< the paths differ from those it was stored with
  std::size_t dropped = 0;        ///< knots that no longer lie on a path
  double evidence_dropped = 0.0;  ///< labels of the dropped knots
  double evidence = 0.0;          ///< labels of the remaining knots
};

/// A friction map as a map file stores it. It reads back to the same numbers and can be extended.
/// Its first property is friction; there may be further properties.
struct FrictionMap {
  LaneStrips strips;
  PropertyMap map;
  double spacing_m = 1.0;  ///< of the knots
  double kernel_width_m = 2.0;
  std::int64_t date_ns = 0;           ///< of the newest measurement
  std::vector<std::string> sessions;  ///< names of those that were used
  FrictionCarry carry;
  std::string paths;                ///< `paths_digest` of its paths
  std::vector<KnotAnchor> anchors;  ///< one for each knot; empty if poses are not known
  std::string config;               ///< text of the configuration that it was begun with
};

}  // namespace roadbook
