#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "drive/detections.hpp"
#include "drive/drive.hpp"
#include "sim/simulate.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Tests may run at the same time, so each test has a separate folder.
fs::path own_folder() {
  const char* test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  return fs::path(::testing::TempDir()) / (std::string("roadbook_sim_") + test);
}

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
  const fs::path out = own_folder();
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
    // The friction of each class is in truth/ and in the documentation.
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

// The scatter of the wheels on their way, by speed. Both drives use the same random draws, and the
// effect scales each draw as declared.
TEST(SimulateReadings, WheelsScatterMoreWhereTheirVarianceGrowsWithSpeed) {
  Scenario scenario = load_scenario("zurich", {});
  scenario.ground.texel_m = 0.05;
  const auto angles = [&](const EffectSizes& effects) {
    SimulateOptions how;
    how.images = false;
    how.effects = effects;
    how.overwrite = true;
    const fs::path out = own_folder();
    (void)simulate(scenario, out, how);
    return Drive::open(out).wheel_readings();
  };
  // Of the mean of both wheels, from reading to reading: three sizes tell motion and noise apart.
  const auto nominal = angles({});
  const auto grown = angles({{"wheels0.variance(speed)", 0.4}});
  const auto more = angles({{"wheels0.variance(speed)", 0.8}});
  ASSERT_EQ(grown.size(), nominal.size());
  double way = 0.0, scatter = 0.0, again = 0.0;
  for (std::size_t i = 1; i < nominal.size(); ++i) {
    const auto step = [&](const std::vector<WheelReading>& r) {
      return 0.5 * scenario.vehicle.wheel_radius_m *
             (r[i].left_angle_rad + r[i].right_angle_rad - r[i - 1].left_angle_rad -
              r[i - 1].right_angle_rad);
    };
    const double by = std::exp(0.2 * (step(nominal) / 0.02 - 2.0)) - 1.0;
    if (std::abs(by) < 0.1) continue;
    const double noise = (step(grown) - step(nominal)) / by;
    way += step(nominal);
    scatter += noise * noise;
    again += std::pow((step(more) - step(nominal)) / (by * (by + 2.0)), 2);
  }
  // The scatter is 1 cm after a metre (sensor.yaml). The bound is four standard errors plus the
  // noise of the readings.
  EXPECT_NEAR(std::sqrt(scatter / way), 0.01, 0.001);
  EXPECT_NEAR(again / scatter, 1.0, 0.05);
}

TEST(SimulateReadings, EffectsOfSensorsThatTheDriveLacksAreRefused) {
  EXPECT_THROW(simulated("zurich", {{"friction0.drying", 1e-4}}), BadInput);
  EXPECT_THROW(simulated("zurich", {{"poses.outliers", 0.1}}), BadInput);
  EXPECT_THROW(simulated("zurich", {{"range0.bias", 0.1}}), BadInput);
}

// Output of a people detector in the small zurich, where two people walk in visit 1; with or
// without noise.
struct People {
  std::vector<Detection> found;
  std::vector<Look> looks;
};
People people_of_zurich(const EffectSizes& effects, bool noise) {
  ScenarioOptions options;
  options.size = "small";
  options.visit = 1;
  Scenario scenario = load_scenario("zurich", options);
  scenario.ground.texel_m = 0.05;
  SimulateOptions how;
  how.images = false;
  how.noise = noise;
  how.detections = true;
  how.effects = effects;
  how.overwrite = true;
  const fs::path out = own_folder();
  (void)simulate(scenario, out, how);
  return {read_detections(detector_folder(out) / "data.csv"),
          read_looks(detector_folder(out) / "looks.csv")};
}

TEST(SimulateDetections, WhereNobodyWalksItIsSaidAtWhichVisitSomebodyDoes) {
  try {
    (void)simulated("zurich", {{"detector.foot_point", 0.25}});
    FAIL() << "accepted";
  } catch (const BadInput& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("nobody walks in zurich at visit 0; try --visit 1"), std::string::npos)
        << what;
  }
}

double range_of(const Detection& d) {
  return std::hypot(d.x_m - (*d.eye_m)[0], d.y_m - (*d.eye_m)[1]);
}

TEST(SimulateDetections, FeetLieFartherAlongTheLineOfSight) {
  const People nominal = people_of_zurich({}, false);
  const People off = people_of_zurich({{"detector.foot_point", 0.25}}, false);
  ASSERT_GT(nominal.found.size(), 40U);
  ASSERT_EQ(off.found.size(), nominal.found.size());
  for (std::size_t i = 0; i < off.found.size(); ++i) {
    const Detection& a = nominal.found[i];
    const Detection& b = off.found[i];
    EXPECT_NEAR(range_of(b) - range_of(a), 0.25, 1e-3);
    // On the same line.
    const double cross = (a.x_m - (*a.eye_m)[0]) * (b.y_m - (*b.eye_m)[1]) -
                         (a.y_m - (*a.eye_m)[1]) * (b.x_m - (*b.eye_m)[0]);
    EXPECT_NEAR(cross / range_of(a), 0.0, 1e-3);
  }
}

TEST(SimulateDetections, WhoIsFarIsFoundLessOften) {
  // Without noise, the detector finds every visible person.
  const People all = people_of_zurich({}, false);
  const People few = people_of_zurich({{"detector.range", 3.0 / 5.0}}, true);
  const auto share = [&](double low, double high) {
    const auto count = [&](const std::vector<Detection>& rows) {
      return static_cast<double>(std::count_if(rows.begin(), rows.end(), [&](const Detection& d) {
        return range_of(d) >= low && range_of(d) < high;
      }));
    };
    return count(few.found) / std::max(count(all.found), 1.0);
  };
  // Log odds of 2.94 less 0.6 a metre: 0.85 at 2 m, 0.16 at 8 m.
  EXPECT_GT(share(1.0, 3.0), 0.6);
  EXPECT_LT(share(6.0, 10.0), 0.4);
}

// The reach of a look must not include hidden ground. Where a look states that it saw the ground,
// the detector finds every person there (without noise, it misses no person).
TEST(SimulateDetections, WhereALookSawTheGroundEverybodyIsFound) {
  const People people = people_of_zurich({}, false);
  const fs::path out = own_folder();
  std::map<std::int64_t, Eigen::Isometry3d> poses;
  for (const TimedPose& p : Drive::open(out).truth()) poses[p.t_ns] = p.T_world_vehicle;
  std::map<std::int64_t, const Look*> looks;
  for (const Look& look : people.looks) looks[look.t_ns] = &look;
  std::ifstream rows(out / "truth" / "pedestrians.csv");
  std::string line;
  std::getline(rows, line);
  std::size_t within = 0;
  while (std::getline(rows, line)) {
    long long t = 0;
    int id = 0;
    double x = 0.0, y = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lld,%d,%lf,%lf", &t, &id, &x, &y), 4);
    if (!poses.contains(t) || !looks.contains(t)) continue;
    const Eigen::Isometry3d& T = poses[t];
    const Eigen::Vector3d p = T.inverse() * Eigen::Vector3d(x, y, T.translation().z());
    const double turn = std::atan2(p.y(), p.x()) / (2.0 * 3.141592653589793);
    const auto k = static_cast<std::size_t>((turn - std::floor(turn)) * 72.0) % 72;
    const auto& reach = looks[t]->reach_dm;
    const int least = std::min({reach[k], reach[(k + 1) % 72], reach[(k + 71) % 72]});
    if (p.head<2>().norm() + 0.5 > 0.1 * least || p.head<2>().norm() < 5.0) continue;
    ++within;
    EXPECT_TRUE(std::any_of(people.found.begin(), people.found.end(), [&](const Detection& d) {
      return d.t_ns == t && std::hypot(d.x_m - p.x(), d.y_m - p.y()) < 0.2;
    })) << line;
  }
  EXPECT_GT(within, 10U);
}

}  // namespace
}  // namespace roadbook
