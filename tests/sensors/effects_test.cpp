#include "sensors/effects.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "base/error.hpp"
#include "sensors/camera_effects.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook {
namespace {

TEST(Effects, EachIsDeclaredOnceAndStandsInTheDocumentation) {
  const auto file = test::source_tree() / "docs" / "reference" / "effects.md";
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::set<std::string_view> names;
  for (const auto& info : all_effects()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    const std::string row = "| `" + std::string(info.name) + "` | " + std::string(info.unit) + " |";
    EXPECT_NE(text.str().find(row), std::string::npos) << row;
    EXPECT_GT(info.plausible, 0.0);
    EXPECT_LT(info.lowest, info.plausible) << info.name;  // 0 is off, also where beyond
    EXPECT_GT(info.highest, info.plausible) << info.name;
  }
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
