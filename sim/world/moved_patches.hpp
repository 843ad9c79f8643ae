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
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]; if `gone`, of the stones' texture
  bool gone = false;                                ///< removed instead of moved

  [[nodiscard]] bool holds(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() < high.array()).all();
  }
};

/// Chooses the share `share` of the squares of 4 m near the route (at least one, none for 0). Each
/// moves by 0.25 to 0.6 m in a random direction. A pure function of its arguments.
[[nodiscard]] std::vector<MovedPatch> moved_patches(const Scenario& scenario,
                                                    double share,
                                                    std::uint64_t seed);

/// Chooses squares as above whose content is removed.
[[nodiscard]] std::vector<MovedPatch> removed_patches(const Scenario& scenario,
                                                      double share,
                                                      std::uint64_t seed);
/// Chooses both kinds by the effects; removed squares come first and are not moved.
[[nodiscard]] std::vector<MovedPatch> changed_patches(const Scenario& scenario,
                                                      const EffectSizes& effects,
                                                      std::uint64_t seed);

/// Moves the content of a raster in the squares. Texels whose source is outside the raster keep
/// their value.
void move_content(const std::vector<MovedPatch>& patches, Canvas& canvas);
/// Paints new asphalt on the removed squares.
void pave(const std::vector<MovedPatch>& patches, const GroundSpec& ground, Canvas& brightness);
/// Sets a raster of class numbers to `road` on the removed squares.
void clear_kinds(const std::vector<MovedPatch>& patches, std::uint8_t road, Canvas& kind);

}  // namespace roadbook
