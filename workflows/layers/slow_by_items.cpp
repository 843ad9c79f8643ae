#include "workflows/layers/slow_by_items.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace roadbook {
namespace {

// The lowest speed that friction, lowered by `factor`, allows at a point; infinite if unknown.
double speed_on_wet(const std::optional<FrictionMap>& friction,
                    const Eigen::Vector2d& p,
                    double factor,
                    const LaneSpeedOptions& options) {
  double lowest = INFINITY;
  if (friction) {
    std::vector<PathPlace> places;
    friction->strips.places_of(p, places);
    for (const PathPlace& place : places)
      if (const auto moments = friction->map.moments(0, place))
        lowest = std::min(lowest, grip_speed_of(*moments, 0.0, options).friction);
  }
  if (!std::isfinite(lowest) && options.unknown_grip > 0.0) lowest = options.unknown_grip;
  if (!std::isfinite(lowest)) return INFINITY;
  return grip_speed(std::max(kLeastFriction, factor * lowest), 0.0, options);
}

}  // namespace

void slow_by_items(SpeedMap& map,
                   const ItemEffects& effects,
                   const std::optional<FrictionMap>& friction) {
  apply_items(map.profiles, effects, map.options);
  for (SpeedCell& cell : map.cells) {
    const EffectAt effect = effects.at(cell.centre, 0.0, cell.speed);
    if (effect.speed < cell.speed) {
      cell.speed = effect.speed;
      cell.speed_sigma = effect.sigma;
    }
    if (!(effect.grip_factor < 1.0)) continue;
    const double wet = speed_on_wet(friction, cell.centre, effect.grip_factor, map.options);
    if (!(wet < cell.speed)) continue;
    cell.speed = wet;
    cell.speed_sigma = 0.0;
  }
}

}  // namespace roadbook
