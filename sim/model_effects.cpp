#include "sim/model_effects.hpp"

#include <cmath>

namespace roadbook {

EffectSizes effects_without_place_hinge(const Scenario& scenario, EffectSizes model) {
  constexpr double kNothing = 1e-9;  // [rad]
  const auto hinge = model.find("ground.hinge");
  if (hinge == model.end() || !scenario.ground.hinge) return model;
  hinge->second -= 2.0 * std::atan(scenario.ground.hinge->slope);
  if (std::abs(hinge->second) < kNothing) model.erase(hinge);
  return model;
}

}  // namespace roadbook
