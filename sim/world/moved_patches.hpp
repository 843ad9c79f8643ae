#pragma once

#include <Eigen/Core>
#include <vector>

#include "sensors/effects.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// A square of the place whose paint, stones and parked cars stand elsewhere than the scenario has
/// them ("map.moved_landmarks"), or are gone: paved anew ("map.landmarks_gone").
struct MovedPatch {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]; of what is gone that of the stones
  bool gone = false;

  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// Squares of 4 m beside the route, as many as make up `share` of them (one at least, none for 0),
/// each moved by 0.25 to 0.6 m in a direction of its own. A pure function of its arguments.
[[nodiscard]] std::vector<MovedPatch> moved_patches(const Scenario& scenario,
                                                    double share,
                                                    std::uint64_t seed);

/// Squares as above whose things are gone.
[[nodiscard]] std::vector<MovedPatch> gone_patches(const Scenario& scenario,
                                                   double share,
                                                   std::uint64_t seed);
/// Both, as the effects say; what is gone stands first and has not moved.
[[nodiscard]] std::vector<MovedPatch> changed_patches(const Scenario& scenario,
                                                      const EffectSizes& effects,
                                                      std::uint64_t seed);

/// Moves what a raster shows of the squares; what comes from beyond the raster stays as it was.
void move_content(const std::vector<MovedPatch>& patches, Canvas& canvas);
/// New asphalt where things are gone.
void pave(const std::vector<MovedPatch>& patches, const GroundSpec& ground, Canvas& brightness);
/// Sets a raster of class numbers to `road` there.
void clear_kinds(const std::vector<MovedPatch>& patches, std::uint8_t road, Canvas& kind);

}  // namespace roadbook
