#include "apps/evaluation/hidden_readings.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "drive/writer.hpp"
#include "sim/streams/detector_stream.hpp"
#include "sim/streams/friction_stream.hpp"
#include "sim/streams/range_stream.hpp"
#include "sim/streams/rig.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/moving.hpp"
#include "sim/world/path.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

using Eigen::Vector2d;

constexpr double kPoseStep = 0.08;        // [s]
constexpr double kReadingStep = 0.1;      // between friction readings [s]
constexpr double kFrictionDrive = 900.0;  // [s]

// Makes a closed country road of 500 to 900 m around the origin, driven at usual speeds.
Scenario random_road(Random& random) {
  Scenario s = load_scenario("road", {"small", 0, 1.0});
  std::array<double, 4> size{}, phase{};
  for (std::size_t k = 0; k < size.size(); ++k) {
    size[k] = random.uniform(0.05, 0.2) / static_cast<double>(k + 1);
    phase[k] = random.uniform(0.0, 2.0 * std::numbers::pi);
  }
  const double radius = random.uniform(75.0, 120.0);
  LaneSpec& lane = s.lanes.front();
  lane.closed = true;
  lane.points.clear();
  double farthest = 0.0;
  constexpr int kCorners = 24;
  for (int i = 0; i < kCorners; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kCorners;
    double r = radius;
    for (std::size_t k = 0; k < size.size(); ++k)
      r += radius * size[k] * std::cos(static_cast<double>(k + 2) * a + phase[k]);
    lane.points.emplace_back(r * std::cos(a), r * std::sin(a));
    farthest = std::max(farthest, r);
  }
  s.ground.low = Vector2d::Constant(-farthest - 15.0);
  s.ground.high = -s.ground.low;
  s.ground.texel_m = 0.25;
  s.ground.wet_per_are = random.uniform(0.4, 1.0);
  s.blocks.clear();
  // The driver is that of the built-in `road`, with a random driving style.
  s.vehicle.max_speed = random.uniform(10.0, 15.0);
  s.vehicle.max_lateral_acceleration = random.uniform(1.5, 3.0);
  s.vehicle.max_acceleration = random.uniform(1.0, 2.0);
  s.vehicle.max_braking = random.uniform(1.5, 2.5);
  s.vehicle.turn_radius_m = 40.0;
  // The car gives way to other traffic once or twice per lap.
  const double length = 2.0 * std::numbers::pi * radius;
  s.stops.clear();
  // The loop draws a new random limit at each step. This has the same effect as one draw: half of
  // the roads have a second stop.
  for (std::uint64_t i = 0; i <= random.below(2); ++i)
    s.stops.push_back({random.uniform(0.2, 0.8) * length, random.uniform(0.5, 3.0)});
  s.laps = {static_cast<int>(std::ceil(kFrictionDrive * s.vehicle.max_speed / length))};
  return s;
}

Scenario car_park(Random& random, int laps) {
  Scenario s = load_scenario("zurich", {"full", 0, 1.0});
  s.seed = random();
  s.ground.texel_m = 0.1;  // no test uses the texture
  s.laps = {laps};
  s.vehicle.max_speed = random.uniform(1.8, 3.0);
  s.pedestrians.clear();
  s.crossings.clear();
  return s;
}

// A car park at noon. It has 80 spaces; 85 % are occupied for one hour each. Each car that arrives
// or leaves brings 1.7 people, who walk or load the car for three to four minutes. This gives 10 to
// 18 people. Four in ten of them do not move.
void add_people(Random& random, Scenario& s) {
  const std::uint64_t people = 10 + random.below(9);
  for (std::uint64_t i = 0; i < people; ++i) {
    const bool stands = random.uniform() < 0.4;
    const double way = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector2d along(std::cos(way), std::sin(way));
    const double half = stands ? 0.3 : random.uniform(2.0, 6.0);
    CrossingSpec c;
    c.name = "way" + std::to_string(i);
    const double x = random.uniform(8.0, 54.0), y = random.uniform(8.0, 24.0);
    c.from = Vector2d(x, y) - half * along;
    c.to = Vector2d(x, y) + half * along;
    c.width_m = 1.0;
    s.crossings.push_back(c);
    s.pedestrians.push_back({c.name, 1, stands ? 0.01 : random.uniform(0.8, 1.5), {0}});
  }
}

std::vector<TimedPose> scattered_poses(const VehicleMotion& drive,
                                       double end_s,
                                       std::int64_t start_ns,
                                       std::uint64_t seed) {
  Random random(seed, "reference poses");
  std::vector<TimedPose> poses;
  for (int k = 0; kPoseStep * k <= end_s; ++k) {
    const Eigen::Vector3d off(kReferenceSigmaM * random.normal(),
                              kReferenceSigmaM * random.normal(), 0.0);
    poses.push_back(
        {start_ns + std::int64_t{80'000'000} * k,
         Eigen::Translation3d(off) * drive.T_world_vehicle(kPoseStep * k) *
             Eigen::AngleAxisd(kReferenceSigmaRad * random.normal(), Eigen::Vector3d::UnitZ())});
  }
  return poses;
}

Scenario hidden_scenario(HiddenKind kind, Random& random) {
  if (kind == HiddenKind::kFriction) return random_road(random);
  Scenario s = car_park(random, kind == HiddenKind::kRange ? 2 : 3);
  if (kind == HiddenKind::kDetector) add_people(random, s);
  return s;
}

}  // namespace

const std::vector<EffectRange>& practical_reading_effects() {
  static const std::vector<EffectRange> kEffects{
      {"friction0.slip_bias", 0.03, 0.2},
      {"friction0.speed_bias", 0.001, 0.01},
      {"friction0.drying", 2.8e-5, 8.3e-5},
      {"friction0.temperature", 0.001, 0.005},
      {"friction0.extra_class", 0.1, 0.3},
      {"friction0.spatial_bias", 0.02, 0.08, true},
      {"friction0.outliers", 0.01, 0.1, true},
      {"friction0.variance(speed)", 0.1, 0.4, true},
      {"friction0.variance(turn)", 2.0, 8.0, true},
      {"friction0.correlation", 0.2, 0.9, true},
      {"range0.short", 0.01, 0.2, true},
      {"range0.maximum", 0.01, 0.1, true},
      {"range0.crosstalk", 0.01, 0.1, true},
      {"range0.outliers", 0.01, 0.1, true},
      {"range0.variance(speed)", 0.2, 0.8, true},
      {"range0.variance(turn)", 2.0, 8.0, true},
      {"range0.correlation", 0.2, 0.9, true},
      {"detector.range", 0.1, 0.4, true},
      {"detector.foot_point", 0.05, 0.4},
  };
  return kEffects;
}

HiddenKind kind_of_effect(const std::string& effect) {
  if (effect.starts_with("friction0.")) return HiddenKind::kFriction;
  if (effect.starts_with("range0.")) return HiddenKind::kRange;
  if (effect.starts_with("detector.")) return HiddenKind::kDetector;
  return HiddenKind::kMotion;
}

void write_hidden_readings(const std::filesystem::path& folder,
                           std::uint64_t seed,
                           HiddenKind kind,
                           const EffectSizes& hidden) {
  ROADBOOK_ASSERT(kind != HiddenKind::kMotion);
  Random random(seed, "hidden place");
  const Scenario scenario = hidden_scenario(kind, random);
  const World world = make_world(scenario, {}, 1);
  Random driver(seed, "hidden driver");
  const VehicleMotion drive =
      drive_line(route_line(scenario, scenario.route), scenario.laps.front(), scenario.stops,
                 scenario.vehicle, world.ground, {}, driver);
  const double end_s = kind == HiddenKind::kFriction ? std::min(kFrictionDrive, drive.duration_s())
                                                     : drive.duration_s();
  const std::int64_t start_ns = drive_start_ns(0);
  const StreamOptions streams{seed, true, hidden};
  DriveWriterOptions options;
  options.overwrite = true;
  DriveWriter writer(folder, {}, std::nullopt, options);
  const Pedestrians people(scenario, drive, seed);
  if (kind == HiddenKind::kFriction) {
    for (const FrictionReading& r :
         simulate_friction(world, drive, start_ns, streams, true, kReadingStep))
      if (r.t_ns <= start_ns + std::llround(1e9 * end_s)) writer.write_friction(r);
  } else if (kind == HiddenKind::kRange) {
    const RangeModel model = nominal_range_model();
    writer.set_range_model(model);
    simulate_ranges(world, drive, people, model, start_ns, end_s, streams,
                    [&](const RangeReading& r) { writer.write_range(r); });
  } else {
    const SimulatedDetections made = simulate_detections(
        world, drive, people, make_rig(scenario.cameras), {}, start_ns, end_s, streams);
    write_detections(detector_folder(folder), made.detections, made.looks);
  }
  writer.write_truth(scattered_poses(drive, end_s, start_ns, seed));
  writer.finish();
}

}  // namespace roadbook
