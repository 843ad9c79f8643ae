#include "sensors/effects.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "sensors/camera_effects.hpp"
#include "tests/support/generated_table.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook {
namespace {

const auto kPage = test::source_tree() / "docs" / "reference" / "effects.md";

// Writes a number with as few digits as give it back.
std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

std::string effect_table(const std::vector<std::span<const EffectInfo>>& groups) {
  std::string table =
      "| effect | unit | plausible size | bounds | grows with | changes |\n"
      "|---|---|---|---|---|---|\n";
  for (const auto& group : groups)
    for (const EffectInfo& e : group) {
      const std::string grows_with = e.covariate.empty() ? "–" : std::string(e.covariate);
      table += "| `" + std::string(e.name) + "` | " + std::string(e.unit) + " | " +
               number(e.plausible) + " | " + number(e.lowest) + " to " + number(e.highest) + " | " +
               grows_with + " | " + std::string(e.description) + " |\n";
    }
  return table;
}

TEST(Effects, EachIsDeclaredOnceWithAPlausibleSizeInsideItsBounds) {
  std::set<std::string_view> names;
  for (const auto& info : all_effects()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_GT(info.plausible, 0.0);
    EXPECT_LT(info.lowest, info.plausible) << info.name;  // 0 is off, also where beyond
    EXPECT_GT(info.highest, info.plausible) << info.name;
  }
}

// To renew the tables: ROADBOOK_WRITE_TABLES=1 build/release/tests/sensors/test_sensors
// --gtest_filter='Effects.*'
TEST(Effects, TheManualHasTheTablesOfTheProgram) {
  test::expect_table_of_page(kPage, "effects of sensors and surroundings",
                             effect_table({wheel_effects(), camera_effects(), imu_effects(),
                                           world_effects(), reading_effects()}));
  test::expect_table_of_page(kPage, "effects of noise", effect_table({noise_effects()}));
}

TEST(Effects, ASizeThatNoSensorCanHaveIsRefusedWithItsBounds) {
  EXPECT_NO_THROW(check_effects(
      {{"wheels0.radius", -0.49}, {"range0.short", 0.0}, {"wheels0.locked_axle", 0.0}}));
  for (const auto& [name, size] : EffectSizes{{"wheels0.radius", -5.0},
                                              {"range0.short", -0.01},
                                              {"wheels0.locked_axle", 0.1},
                                              {"cam3.latency", 30.0}})
    EXPECT_THROW(check_effects({{name, size}}), BadInput) << name;
  try {
    check_effects({{"wheels0.radius", -5.0}});
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_EQ(std::string(error.what()),
              "error: effects: got wheels0.radius = -5, want -0.5 to 0.5");
  }
}

TEST(Effects, ACamerasOwnSizeAndThatOfTheRigAddUp) {
  const EffectSizes sizes{{"cam.focal", 0.01}, {"cam2.focal", 0.02}};
  EXPECT_DOUBLE_EQ(effect_size(sizes, "cam2", "focal"), 0.03);
  EXPECT_EQ(effect_size(sizes, "cam", "focal"), 0.01);
  EXPECT_EQ(effect_size(sizes, "cam1", "focal"), 0.01);
  EXPECT_EQ(effect_size(sizes, "wheels0", "radius"), 0.0);
}

TEST(Effects, ASumBeyondTheBoundsIsRefusedAsOneSizeIs) {
  EXPECT_NO_THROW(check_effects({{"cam.exposure", -0.6}, {"cam1.exposure", 0.5}}));
  try {
    check_effects({{"cam.exposure", -0.6}, {"cam1.exposure", -0.5}});
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "error: effects: got cam1.exposure and cam.exposure = -1.1 together, want -0.95 to 9");
  }
}

TEST(Effects, AnUnknownNameIsRefusedWithTheNearest) {
  EXPECT_NO_THROW(check_effects({{"cam3.rotation", 0.1}, {"wheels0.left_radius", 0.1}}));
  try {
    check_effects({{"wheels0.left_radios", 0.1}});
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("wheels0.left_radius"), std::string::npos);
  }
}

TEST(Effects, ACameraTurnedToItsRightSeesItsAxisOnTheRight) {
  MountedCamera nominal;
  nominal.name = "cam1";
  const auto real = apply_camera_effects(nominal, {{"cam1.rotation", 0.1}, {"cam.position", 0.2}});
  EXPECT_NEAR((real.T_vehicle_camera.linear() * Eigen::Vector3d::UnitZ()).x(), std::sin(0.1),
              1e-15);
  EXPECT_EQ(real.T_vehicle_camera.translation().x(), 0.2);
}

}  // namespace
}  // namespace roadbook
