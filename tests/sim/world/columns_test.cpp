#include <gtest/gtest.h>

#include <algorithm>

#include "sim/world/world.hpp"

namespace roadbook {
namespace {

// Yellow columns stand in place of the painted lines that a scenario names, and on no others.
TEST(World, OnlyLinesOfColumnsHaveThem) {
  ScenarioOptions options;
  options.size = "small";
  Scenario scenario = load_scenario("zurich", options);
  scenario.ground.texel_m = 0.1;  // nobody looks at the paint
  const World world = make_world(scenario, {}, 1);
  int columns = 0;
  for (const SpaceLine& line : world.layout.lines) {
    const Eigen::Vector2d middle = 0.5 * (line.front + line.back);
    const auto& triangles = world.mesh.triangles;
    const bool found = std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
      const Eigen::Vector3f centre = (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0F;
      return t.kind == SurfaceClass::kPillar &&
             (centre.head<2>().cast<double>() - middle).norm() < 0.2;
    });
    EXPECT_EQ(found, line.column);
    columns += line.column ? 1 : 0;
  }
  EXPECT_GT(columns, 0);
  EXPECT_GT(static_cast<int>(world.layout.lines.size()), columns);
}

}  // namespace
}  // namespace roadbook
