#pragma once

#include <Eigen/Core>
#include <vector>

#include "sensors/effects.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// A square of the place whose paint, stones and parked cars have moved ("map.moved_landmarks"), or
/// were removed by new pavement ("map.landmarks_gone").
struct MovedPatch {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]; of what is gone that of the stones
  bool gone = false;

  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// Squares of 4 m near the route, as many as make up `share` of them (one at least, none for 0).
/// Each moves by 0.25 to 0.6 m in a random direction. A pure function of its arguments.
[[nodiscard]] std::vector<MovedPatch> moved_patches(const Scenario& scenario,
                                                    double share,
                                                    std::uint64_t seed);

/// Squares as above whose things are removed.
[[nodiscard]] std::vector<MovedPatch> gone_patches(const Scenario& scenario,
                                                   double share,
                                                   std::uint64_t seed);
/// Both kinds, as the effects state; removed squares come first and have not moved.
[[nodiscard]] std::vector<MovedPatch> changed_patches(const Scenario& scenario,
                                                      const EffectSizes& effects,
                                                      std::uint64_t seed);

/// Moves what a raster shows of the squares; what comes from beyond the raster stays as it was.
void move_content(const std::vector<MovedPatch>& patches, Canvas& canvas);
/// New asphalt on the squares whose things are removed.
void pave(const std::vector<MovedPatch>& patches, const GroundSpec& ground, Canvas& brightness);
/// Sets a raster of class numbers to `road` there.
void clear_kinds(const std::vector<MovedPatch>& patches, std::uint8_t road, Canvas& kind);

}  // namespace roadbook
