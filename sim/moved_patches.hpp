#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/paint.hpp"
#include "sim/scenario.hpp"

namespace roadbook {

/// A square of the place whose paint, stones and parked cars stand elsewhere than the scenario has
/// them ("map.moved_landmarks").
struct MovedPatch {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]

  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// Squares of 4 m beside the route, as many as make up `share` of them (one at least, none for 0),
/// each moved by 0.25 to 0.6 m in a direction of its own. A pure function of its arguments.
[[nodiscard]] std::vector<MovedPatch> moved_patches(const Scenario& scenario,
                                                    double share,
                                                    std::uint64_t seed);

/// Moves what a raster shows of the squares; what comes from beyond the raster stays as it was.
void move_content(const std::vector<MovedPatch>& patches, Canvas& canvas);

}  // namespace roadbook
