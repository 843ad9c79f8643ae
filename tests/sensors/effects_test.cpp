#include "sensors/effects.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <map>
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

TEST(Effects, AMountingEffectMovesACameraAlongOneAxisOfTheVehicle) {
  MountedCamera nominal;
  nominal.name = "cam1";
  nominal.T_vehicle_camera.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  const auto real = apply_camera_effects(
      nominal, {{"cam1.lateral", 0.1}, {"cam.height", 0.2}, {"cam2.height", 5.0}});
  EXPECT_EQ(real.T_vehicle_camera.translation(), Eigen::Vector3d(1.0, 2.1, 3.2));
}

// By hand: the left end of an axle, seen from above, goes ahead if the body turns to its right, and
// up if it leans to its right; the front goes up with its pitch.
TEST(Effects, ATurnOfTheRigTurnsPlacesAndDirectionsOfAllCamerasAsOneBody) {
  const auto turned = [](const char* effect, const Eigen::Vector3d& place) {
    MountedCamera nominal;
    nominal.name = "cam3";
    nominal.T_vehicle_camera.translation() = place;
    return apply_camera_effects(nominal, {{effect, 0.1}});
  };
  const Eigen::Vector3d ahead(1.0, 0.0, 0.0);
  const Eigen::Vector3d left(0.0, 1.0, 0.0);
  const double c = std::cos(0.1);
  const double s = std::sin(0.1);
  const auto right = turned("rig.rotation", ahead);
  EXPECT_NEAR((right.T_vehicle_camera.translation() - Eigen::Vector3d(c, -s, 0.0)).norm(), 0.0,
              1e-15);
  EXPECT_NEAR((right.T_vehicle_camera.linear() * left - Eigen::Vector3d(s, c, 0.0)).norm(), 0.0,
              1e-15);
  const auto up = turned("rig.pitch", ahead);
  EXPECT_NEAR((up.T_vehicle_camera.translation() - Eigen::Vector3d(c, 0.0, s)).norm(), 0.0, 1e-15);
  const auto leaning = turned("rig.roll", left);
  EXPECT_NEAR((leaning.T_vehicle_camera.translation() - Eigen::Vector3d(0.0, c, s)).norm(), 0.0,
              1e-15);
}

TEST(Effects, EachPartOfALensHasItsOwnEffectInEveryModel) {
  struct Model {
    CameraModel model;
    std::size_t focal, distortion, distortion2;
  };
  for (const Model& m : {Model{CameraModel::kPinholeRadtan, 0, 4, 5},
                         {CameraModel::kKannalaBrandt, 0, 4, 5},
                         {CameraModel::kOmni, 1, 5, 6},
                         {CameraModel::kDoubleSphere, 2, 1, 0}}) {
    MountedCamera nominal;
    nominal.name = "cam0";
    nominal.camera.model = m.model;
    nominal.camera.parameters = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    const auto change = [&](const std::string& effect) {
      auto q = apply_camera_effects(nominal, {{"cam0." + effect, 0.02}}).camera.parameters;
      for (std::size_t i = 0; i < q.size(); ++i) q[i] -= nominal.camera.parameters[i];
      return q;
    };
    const double fx = nominal.camera.parameters[m.focal];
    const double fy = nominal.camera.parameters[m.focal + 1];
    const std::map<std::string, std::map<std::size_t, double>> want{
        {"aspect", {{m.focal, 0.01 * fx}, {m.focal + 1, -0.01 * fy}}},
        {"focal", {{m.focal, 0.02 * fx}, {m.focal + 1, 0.02 * fy}}},
        {"centre_x", {{m.focal + 2, 0.02}}},
        {"centre_y", {{m.focal + 3, 0.02}}},
        {"centre", {{m.focal + 2, 0.02}, {m.focal + 3, 0.02}}},
        {"distortion", {{m.distortion, 0.02}}},
        {"distortion2", {{m.distortion2, 0.02}}}};
    for (const auto& [effect, parameters] : want) {
      const auto got = change(effect);
      for (std::size_t i = 0; i < got.size(); ++i)
        EXPECT_NEAR(got[i], parameters.contains(i) ? parameters.at(i) : 0.0, 1e-15)
            << effect << " of " << camera_model_name(m.model) << ", parameter " << i;
    }
  }
}

}  // namespace
}  // namespace roadbook
