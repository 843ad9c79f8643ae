#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "sim/simulate.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

Drive simulated(const std::string& place, const EffectSizes& effects, bool ranges = false) {
  ScenarioOptions options;
  options.size = "small";
  Scenario scenario = load_scenario(place, options);
  scenario.ground.texel_m = 0.05;  // seconds instead of tens of them
  SimulateOptions how;
  how.images = false;
  how.noise = false;
  how.effects = effects;
  how.ranges = ranges;
  how.temperature = true;
  how.max_duration_s = 20.0;
  how.overwrite = true;
  const fs::path out = fs::path(::testing::TempDir()) / "roadbook_sim_readings";
  (void)simulate(scenario, out, how);
  return Drive::open(out);
}

std::vector<FrictionReading> friction_of_drive(const Drive& drive) {
  std::vector<FrictionReading> all;
  drive.for_each_friction_reading([&](const FrictionReading& r) { all.push_back(r); });
  return all;
}

std::vector<RangeReading> ranges_of_drive(const Drive& drive) {
  std::vector<RangeReading> all;
  drive.for_each_range_reading([&](const RangeReading& r) { all.push_back(r); });
  return all;
}

TEST(SimulateReadings, FrictionEffectsChangeReadingsAsDeclared) {
  const auto nominal = friction_of_drive(simulated("road", {}));
  ASSERT_GT(nominal.size(), 500U);
  for (const FrictionReading& r : nominal) {
    ASSERT_TRUE(r.surface && r.temperature_c);
    // The classes' friction stands in truth/ and in the documentation.
    const double want = *r.surface == 4   ? 0.55
                        : *r.surface == 5 ? 0.40
                        : *r.surface == 1 ? 0.9
                                          : 0.75;
    EXPECT_NEAR(r.friction, want, 1e-12);
  }
  const auto dry = friction_of_drive(simulated("road", {{"friction0.drying", 1e-3}}));
  const auto warm = friction_of_drive(simulated("road", {{"friction0.temperature", 0.004}}));
  ASSERT_EQ(dry.size(), nominal.size());
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    const double t = 1e-9 * static_cast<double>(nominal[i].t_ns - nominal.front().t_ns);
    EXPECT_NEAR(dry[i].friction - nominal[i].friction, *nominal[i].surface == 5 ? 1e-3 * t : 0.0,
                1e-12);
    EXPECT_NEAR(warm[i].friction - nominal[i].friction, 0.004 * (*nominal[i].temperature_c - 20.0),
                1e-12);
  }
}

TEST(SimulateReadings, ScannerReadsTheSharesOfTheBeamModelAndOtherwiseDistances) {
  const auto nominal = ranges_of_drive(simulated("zurich", {}, true));
  const auto off = ranges_of_drive(simulated("zurich", {{"range0.maximum", 0.1}}));
  ASSERT_GT(nominal.size(), 5000U);
  ASSERT_EQ(off.size(), nominal.size());
  double changed = 0.0, could = 0.0;
  for (std::size_t i = 0; i < nominal.size(); ++i) {
    EXPECT_GE(nominal[i].range_m, 0.0);
    EXPECT_LE(nominal[i].range_m, 10.0);
    if (nominal[i].range_m >= 10.0) continue;
    could += 1.0;
    if (off[i].range_m == nominal[i].range_m) continue;
    changed += 1.0;
    EXPECT_EQ(off[i].range_m, 10.0);
  }
  // Four standard errors of a share.
  EXPECT_NEAR(changed / could, 0.1, 4.0 * std::sqrt(0.09 / could));
}

TEST(SimulateReadings, EffectsOfSensorsThatTheDriveLacksAreRefused) {
  EXPECT_THROW(simulated("zurich", {{"friction0.drying", 1e-4}}), BadInput);
  EXPECT_THROW(simulated("zurich", {{"poses.outliers", 0.1}}), BadInput);
  EXPECT_THROW(simulated("zurich", {{"range0.bias", 0.1}}), BadInput);
}

}  // namespace
}  // namespace roadbook
