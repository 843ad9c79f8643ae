#include "apps/evaluation/hidden_drive.hpp"

#include <cmath>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "sensors/pose_imperfections.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

constexpr double kTruePoseStep = 0.08;  // [s]

// Makes a random route with the straights and bends of a car park, and a few stops.
DrivingLine random_route(Random& random, double length_m, std::vector<StopSpec>& stops) {
  std::vector<Eigen::Vector2d> corners{{0.0, 0.0}};
  double heading = random.uniform(-3.0, 3.0);
  for (double at = 0.0; at < length_m;) {
    const double leg = random.uniform(14.0, 35.0);
    corners.emplace_back(corners.back() +
                         leg * Eigen::Vector2d(std::cos(heading), std::sin(heading)));
    if (random.uniform() < 0.25) stops.push_back({at + random.uniform(0.3, 0.7) * leg, 1.5});
    heading += (random.uniform() < 0.5 ? -1.0 : 1.0) * random.uniform(0.5, 1.9);
    at += leg;
  }
  return {corners, random.uniform(5.0, 9.0), false};
}

VehicleMotion random_motion(std::uint64_t seed, double length_m, World& world) {
  Random random(seed, "hidden route");
  VehicleSpec& vehicle = world.scenario.vehicle;
  vehicle.max_speed = random.uniform(2.5, 5.0);
  vehicle.max_lateral_acceleration = random.uniform(0.8, 2.0);
  // Drivers in routine stops brake with up to 2.5 m/s^2 at the speeds of a car park (Roenitz,
  // Happer, Johal, Overgaard 1999: 0.25 g at 20 to 30 km/h, all kinds of cars).
  Random pedals(seed, "hidden pedals");
  vehicle.max_acceleration = pedals.uniform(1.0, 2.0);
  vehicle.max_braking = pedals.uniform(1.5, 2.5);
  // Values of a RAV4 on a road (comma2k19), after a fit of speed, acceleration and turn rate. The
  // rear wheels differ by 0.6 to 1.2 mm from metre to metre, the axles by 2.6 to 5 mm
  // (docs/guide/diagnosis.md).
  vehicle.distance_scatter_m = 0.003;
  vehicle.heading_scatter_rad = 0.001;
  const DrivingLine line = random_route(random, length_m, world.scenario.stops);
  DriverOptions driver;
  driver.lateral_slip_per_sqrt_m = nominal_wheels(vehicle).sigma_lateral_per_sqrt_m;
  return drive_line(line, 1, world.scenario.stops, vehicle, world.ground, driver, random);
}

// Errors that last, pose by pose: x, y [m] and heading [rad].
std::vector<Eigen::Vector3d> lasting_errors(std::size_t poses,
                                            std::uint64_t seed,
                                            const LastingReference& reference) {
  std::vector<Eigen::Vector3d> errors(poses, Eigen::Vector3d::Zero());
  if (reference.time_s <= 0.0) return errors;
  Random random(seed, "lasting errors of the reference");
  const Eigen::Vector3d sigma(reference.position_m, reference.position_m, reference.heading_rad);
  const double stays = std::exp(-kTruePoseStep / reference.time_s);
  const auto draw = [&] {
    const double x = random.normal();
    const double y = random.normal();
    return Eigen::Vector3d(sigma.cwiseProduct(Eigen::Vector3d(x, y, random.normal())));
  };
  Eigen::Vector3d error = draw();
  for (Eigen::Vector3d& at : errors) {
    at = error;
    error = stays * error + std::sqrt(1.0 - stays * stays) * draw();
  }
  return errors;
}

std::vector<TimedPose> reference_poses(const VehicleMotion& motion,
                                       std::int64_t start_ns,
                                       std::uint64_t seed,
                                       const EffectSizes& hidden,
                                       const LastingReference& reference) {
  Random random(seed, "reference poses");
  PoseImperfections<double> off;
  off.latency = effect_size(hidden, "cam", "latency");
  off.rotation = effect_size(hidden, "cam", "rotation");
  off.position = effect_size(hidden, "cam", "position");
  off.scale = effect_size(hidden, "map", "scale");
  off.bend = effect_size(hidden, "map", "bend");
  const VehicleState first = motion.at(-off.latency);
  const PlanarPose<double> origin{first.x, first.y, 0.0};
  // One more than there are: a product may round otherwise than a quotient.
  const auto lasting = lasting_errors(
      static_cast<std::size_t>(motion.duration_s() / kTruePoseStep) + 2, seed, reference);
  std::vector<TimedPose> poses;
  for (int k = 0; kTruePoseStep * k <= motion.duration_s(); ++k) {
    const VehicleState s = motion.at(kTruePoseStep * k - off.latency);
    const auto read = predict_pose(off, PlanarPose<double>{s.x, s.y, s.heading}, origin);
    TimedPose p;
    p.t_ns = start_ns + std::int64_t{80'000'000} * k;
    const Eigen::Vector3d& off_by = lasting[static_cast<std::size_t>(k)];
    const double x = read.x + off_by.x() + reference.white_m * random.normal();
    const double y = read.y + off_by.y() + reference.white_m * random.normal();
    const double heading = read.heading + off_by.z() + reference.white_rad * random.normal();
    p.T_world_vehicle =
        Eigen::Translation3d(x, y, 0.0) * Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ());
    poses.push_back(p);
  }
  return poses;
}

}  // namespace

const std::vector<EffectRange>& practical_effects() {
  static const std::vector<EffectRange> kEffects{{"wheels0.left_radius", 0.003, 0.02},
                                                 {"wheels0.right_radius", 0.003, 0.02},
                                                 {"wheels0.radius", 0.003, 0.02},
                                                 {"wheels0.radius_difference", 0.002, 0.01},
                                                 {"wheels0.track_width", 0.01, 0.05},
                                                 {"wheels0.locked_axle", 0.9, 1.0, true},
                                                 {"wheels0.latency", 0.005, 0.08},
                                                 {"wheels0.slip_acceleration", 0.002, 0.01},
                                                 {"wheels0.radius_speed", 0.001, 0.005},
                                                 {"wheels0.eccentricity", 0.005, 0.02},
                                                 {"steering0.offset", 0.0035, 0.026},
                                                 {"steering0.ratio", 0.01, 0.10},
                                                 {"steering0.understeer", 0.0008, 0.0023},
                                                 {"steering0.wheelbase", 0.02, 0.10},
                                                 {"steering0.latency", 0.01, 0.08},
                                                 {"imu0.gyro_bias", 0.00035, 0.005},
                                                 {"imu0.gyro_scale", 0.005, 0.02},
                                                 {"imu0.latency", 0.005, 0.05},
                                                 {"imu0.tilt_roll", 0.005, 0.1},
                                                 {"imu0.tilt_pitch", 0.005, 0.1},
                                                 {"clock.drift", 1e-5, 1e-4},
                                                 {"cam.latency", 0.005, 0.08},
                                                 {"cam.rotation", 0.0017, 0.017},
                                                 {"cam.position", 0.01, 0.10},
                                                 {"map.scale", 0.003, 0.02},
                                                 {"map.bend", 5e-5, 3e-4},
                                                 {"wheels0.outliers", 0.01, 0.1, true},
                                                 {"wheels0.variance(speed)", 0.2, 0.8, true},
                                                 {"wheels0.variance(turn)", 2.0, 8.0, true},
                                                 {"imu0.outliers", 0.01, 0.1, true},
                                                 {"steering0.outliers", 0.01, 0.1, true},
                                                 {"imu0.variance(turn)", 2.0, 8.0, true},
                                                 {"imu0.correlation", 0.2, 0.9, true}};
  return kEffects;
}

double draw_size(const EffectRange& range, std::uint64_t seed) {
  Random random(seed, "hidden size " + range.name);
  const double size = range.low * std::pow(range.high / range.low, random.uniform());
  return random.uniform() < 0.5 && !range.positive ? -size : size;
}

LastingReference draw_lasting_reference(double time_s, std::uint64_t seed) {
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  Random random(seed, "sizes of the reference's errors");
  const auto draw = [&](double low, double high) {
    return low * std::pow(high / low, random.uniform());
  };
  LastingReference reference;
  reference.time_s = time_s;
  reference.position_m = draw(0.01, 0.5);
  reference.heading_rad = draw(0.03, 0.5) * kDegree;
  reference.white_m = draw(0.003, 0.03);
  reference.white_rad = draw(0.02, 0.1) * kDegree;
  return reference;
}

void write_hidden_drive(const std::filesystem::path& folder,
                        std::uint64_t seed,
                        double length_m,
                        const EffectSizes& hidden,
                        const LastingReference& reference) {
  World world;
  const VehicleMotion motion = random_motion(seed, length_m, world);
  const std::int64_t start_ns = drive_start_ns(0);
  StreamOptions streams;
  streams.seed = seed;
  streams.effects = hidden;
  DriveWriterOptions options;
  options.wheel_rate_hz = 50.0;
  options.overwrite = true;
  DriveWriter writer(folder, {}, nominal_wheels(world.scenario.vehicle), options);
  for (const auto& r : simulate_wheels(world, motion, start_ns, streams)) writer.write_wheels(r);
  for (const auto& r : simulate_imu(motion, start_ns, streams)) writer.write_imu(r);
  writer.write_truth(reference_poses(motion, start_ns, seed, hidden, reference));
  writer.finish();
}

}  // namespace roadbook
