#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

/// A rectangle of the map's plane [m].
struct PlanBounds {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Ones();

  /// Returns the bounds of all points with a margin of a twentieth, at least one metre wide.
  static PlanBounds around(const std::vector<Eigen::Vector2d>& points);
};

}  // namespace roadbook
