#include "sim/model_effects.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/ground.hpp"

namespace roadbook {
namespace {

// Change of slope where the ground bends, from heights on both sides of the line.
double change_of_slope(const GroundSpec& spec, const EffectSizes& effects) {
  GroundEffects of_ground;
  of_ground.hinge = effect_size(effects, "ground", "hinge");
  const Ground ground(spec, of_ground);
  const Eigen::Vector2d at = spec.hinge ? spec.hinge->from : 0.5 * (spec.low + spec.high);
  const double rise = ground.height(at.x(), at.y() + 1.0) - ground.height(at.x(), at.y());
  const double fall = ground.height(at.x(), at.y()) - ground.height(at.x(), at.y() - 1.0);
  return std::atan(rise) - std::atan(fall);
}

// zurich has a bend of 4 degrees, which diagnosis finds and writes. An earlier simulation with that
// model had 8 degrees.
TEST(ModelEffects, AFoundHingeIsThatOfThePlaceAndDoesNotDouble) {
  const Scenario zurich = load_scenario("zurich", {});
  const double built = change_of_slope(zurich.ground, {});
  ASSERT_NEAR(built, 2.0 * std::atan(0.035), 1e-9);
  for (const double found : {built, 0.05, 0.09}) {
    const EffectSizes effects =
        effects_without_place_hinge(zurich, {{"ground.hinge", found}, {"cam0.focal", 0.01}});
    EXPECT_NEAR(change_of_slope(zurich.ground, effects), found, 1e-9);
    EXPECT_EQ(effects.at("cam0.focal"), 0.01);
  }
  EXPECT_FALSE(
      effects_without_place_hinge(zurich, {{"ground.hinge", built}}).contains("ground.hinge"));
}

TEST(ModelEffects, WhereThePlaceIsFlatAFoundHingeIsAllThereIs) {
  const Scenario flat = load_scenario("stuttgart", {});
  ASSERT_FALSE(flat.ground.hinge);
  const EffectSizes effects = effects_without_place_hinge(flat, {{"ground.hinge", 0.05}});
  EXPECT_NEAR(change_of_slope(flat.ground, effects), 0.05, 1e-9);
}

}  // namespace
}  // namespace roadbook
