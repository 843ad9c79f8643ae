#include "sim/streams/sensor_streams.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "base/se3.hpp"
#include "sensors/imu_imperfections.hpp"
#include "sensors/steering.hpp"
#include "sensors/stream_noise.hpp"
#include "sensors/wheel_imperfections.hpp"

namespace roadbook {
namespace {

/// The stamp a sensor's own clock gives to time t of the drive.
std::int64_t stamp_of(double t_s, double drift, std::int64_t start_ns) {
  return start_ns + static_cast<std::int64_t>(std::llround(t_s * (1.0 + drift) * 1e9));
}

/// Turns of both rear wheels since the start, at every state of the drive.
struct WheelTurns {
  std::vector<double> left;
  std::vector<double> right;
};

WheelTurns turn_wheels(const World& world,
                       const VehicleMotion& drive,
                       const WheelModel& nominal,
                       const StreamOptions& options) {
  const WheelImperfections<double> off = wheel_imperfections(options.effects);
  const NoiseImperfections noise = noise_imperfections(options.effects, "wheels0");
  Random random(options.seed, "wheel noise", static_cast<std::uint64_t>(world.scenario.visit));
  WheelTurns turns{{0.0}, {0.0}};
  const auto& states = drive.states();
  for (std::size_t i = 1; i < states.size(); ++i) {
    const VehicleState& s = states[i];
    double moved = s.distance_m - states[i - 1].distance_m;
    double turned = s.turned - states[i - 1].turned;
    if (options.noise && moved > 0.0) {
      const double scatter = std::sqrt(moved) * noise_growth(noise, s.speed, s.yaw_rate);
      moved += nominal.sigma_distance_per_sqrt_m * scatter * random.normal();
      turned += nominal.sigma_heading_per_sqrt_m * scatter * random.normal();
    }
    const bool wet = off.wet_patch != 0.0 && ground_kind(world, s.x, s.y) == SurfaceClass::kWater;
    const TrueMotion<double> motion{
        moved, turned, s.speed, s.acceleration, turns.left.back(), turns.right.back(), wet};
    const Eigen::Vector2d turn = predict_wheel_turns(nominal, off, motion);
    turns.left.push_back(turns.left.back() + turn.x());
    turns.right.push_back(turns.right.back() + turn.y());
  }
  return turns;
}

double interpolated(const std::vector<double>& values, double u) {
  const double c = std::clamp(u, 0.0, static_cast<double>(values.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(c), values.size() - 2);
  return values[i] + (c - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

}  // namespace

std::int64_t drive_start_ns(int visit) {
  return 1'400'000'000'000'000'000LL + visit * 86'400'000'000'000LL;
}

WheelModel nominal_wheels(const VehicleSpec& vehicle) {
  WheelModel model;
  model.radius_left_m = model.radius_right_m = vehicle.wheel_radius_m;
  model.track_width_m = vehicle.track_width_m;
  model.wheelbase_m = vehicle.wheelbase_m;
  model.sigma_distance_per_sqrt_m = vehicle.distance_scatter_m;
  model.sigma_heading_per_sqrt_m = vehicle.heading_scatter_rad;
  return model;
}

std::vector<WheelReading> simulate_wheels(const World& world,
                                          const VehicleMotion& drive,
                                          std::int64_t start_ns,
                                          const StreamOptions& options) {
  const WheelModel nominal = nominal_wheels(world.scenario.vehicle);
  const WheelTurns turns = turn_wheels(world, drive, nominal, options);
  const double latency = effect_size(options.effects, "wheels0", "latency");
  const double drift = effect_size(options.effects, "clock", "drift");
  const SteeringImperfections<double> off = steering_imperfections(options.effects);
  const double step = drive.duration_s() / static_cast<double>(drive.states().size() - 1);
  Random random(options.seed, "wheel readings", static_cast<std::uint64_t>(world.scenario.visit));
  StreamNoise left(options.effects, "wheels0");
  StreamNoise right(options.effects, "wheels0");
  StreamNoise steering(options.effects, "steering0");
  std::vector<WheelReading> readings;
  for (int k = 0; 0.02 * k <= drive.duration_s(); ++k) {
    const double t = 0.02 * k;
    const double seen = t - latency;
    const VehicleState state = drive.at(seen);
    const auto noise = [&](StreamNoise& of, double sigma) {
      return options.noise ? sigma * of.next(random, state.speed, state.yaw_rate) : 0.0;
    };
    WheelReading reading;
    reading.t_ns = stamp_of(t, drift, start_ns);
    reading.left_angle_rad =
        interpolated(turns.left, seen / step) + noise(left, nominal.sigma_angle_rad);
    reading.right_angle_rad =
        interpolated(turns.right, seen / step) + noise(right, nominal.sigma_angle_rad);
    const VehicleState steered = drive.at(seen - off.latency);
    const double angle = std::atan((1.0 + off.wheelbase) * std::tan(steered.steering)) *
                         (1.0 + off.understeer * steered.speed * steered.speed);
    reading.steering_rad = angle * (1.0 + off.ratio) + off.offset + noise(steering, 0.002);
    readings.push_back(reading);
  }
  return readings;
}

std::vector<ImuReading> simulate_imu(const VehicleMotion& drive,
                                     std::int64_t start_ns,
                                     const StreamOptions& options) {
  constexpr double kHalf = 0.02;  // [s] of the differences
  const double latency = effect_size(options.effects, "imu0", "latency");
  const double bias = effect_size(options.effects, "imu0", "gyro_bias");
  const double scale = effect_size(options.effects, "imu0", "gyro_scale");
  const Eigen::Matrix3d tilt = tilt_rotation(options.effects);
  const double drift = effect_size(options.effects, "clock", "drift");
  Random random(options.seed, "imu");
  std::vector<StreamNoise> noise(6, StreamNoise(options.effects, "imu0"));
  std::vector<ImuReading> readings;
  for (int k = 0; 0.01 * k <= drive.duration_s(); ++k) {
    const double t = 0.01 * k - latency;
    const Eigen::Isometry3d before = drive.T_world_vehicle(t - kHalf);
    const Eigen::Isometry3d now = drive.T_world_vehicle(t);
    const Eigen::Isometry3d after = drive.T_world_vehicle(t + kHalf);
    ImuReading reading;
    reading.t_ns = stamp_of(0.01 * k, drift, start_ns);
    const Eigen::Vector3d turning =
        so3_log(before.linear().transpose() * after.linear()) / (2.0 * kHalf);
    const Eigen::Vector3d acceleration =
        (after.translation() - 2.0 * now.translation() + before.translation()) / (kHalf * kHalf);
    reading.angular_velocity_rad_s =
        tilt.transpose() * turning * (1.0 + scale) + Eigen::Vector3d(0.0, 0.0, bias);
    reading.specific_force_m_s2 = tilt.transpose() * now.linear().transpose() *
                                  (acceleration + Eigen::Vector3d(0.0, 0.0, 9.81));
    const VehicleState state = drive.at(t);
    for (Eigen::Index i = 0; options.noise && i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      reading.angular_velocity_rad_s[i] +=
          0.002 * noise[axis].next(random, state.speed, state.yaw_rate);
      reading.specific_force_m_s2[i] +=
          0.03 * noise[axis + 3].next(random, state.speed, state.yaw_rate);
    }
    readings.push_back(reading);
  }
  return readings;
}

}  // namespace roadbook
