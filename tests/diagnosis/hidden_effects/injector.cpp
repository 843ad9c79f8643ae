#include "tests/diagnosis/hidden_effects/injector.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "tests/diagnosis/hidden_effects/noise_source.hpp"
#include "tests/diagnosis/hidden_effects/vehicle.hpp"

namespace roadbook::test {
namespace {

// True random walk of the wheels: less than sensor.yaml states, so diagnosis must estimate it.
constexpr double kDistanceWalk = 0.003;  // [m] after 1 m
constexpr double kHeadingWalk = 0.001;   // [rad] after 1 m

// Angles of both wheels at every tick, walking noise included.
struct Wheels {
  std::vector<double> left{0.0}, right{0.0};
};

// Bends are banked inwards by one angle: the car turns about its own axis by the cosine of it.
double bank_of(const Secret& s) { return std::acos(1.0 - of(s, "ground.bank")); }
double kept_of_turn(const Secret& s) { return std::cos(bank_of(s)); }

Wheels roll(const std::vector<Moment>& drive, const HiddenDriveOptions& o, const WheelModel& m) {
  const Secret& s = o.secret;
  Random random(o.seed, "wheel walk");
  const NoiseSource noise(o, "wheels0", 0);  // what scatters on the way grows as readings do
  const double both = of(s, "wheels0.radius");
  const double half = 0.5 * of(s, "wheels0.radius_difference");
  const double r_left = m.radius_left_m * (1.0 + both + of(s, "wheels0.left_radius") - half);
  const double r_right = m.radius_right_m * (1.0 + both + of(s, "wheels0.right_radius") + half);
  const double track = m.track_width_m * (1.0 + of(s, "wheels0.track_width"));
  const double missing = of(s, "wheels0.locked_axle");
  const double eccentric = of(s, "wheels0.eccentricity");
  // A puddle somewhere on the way.
  Random place(o.seed, "puddle");
  const Moment& puddle =
      drive[static_cast<std::size_t>(place.uniform(0.2, 0.8) * static_cast<double>(drive.size()))];
  Wheels wheels;
  double true_left = 0.0, true_right = 0.0;
  for (std::size_t i = 1; i < drive.size(); ++i) {
    const Moment& a = drive[i - 1];
    const Moment& b = drive[i];
    double moved = b.distance - a.distance;
    double turned = kept_of_turn(s) * (b.turned - a.turned);
    const double root = std::sqrt(std::abs(moved)) * noise.growth(b);
    const double speed = 0.5 * (a.speed + b.speed);
    moved += kDistanceWalk * root * random.normal();
    turned += kHeadingWalk * root * random.normal();
    const double across = (1.0 - missing) * 0.5 * track * turned;
    double slip = 1.0 + of(s, "wheels0.slip_acceleration") * b.acceleration;
    const double t = kTick * static_cast<double>(i);
    slip += of(s, "outside.tyre_warming") * t + of(s, "outside.wheels_by_column") * o.acting(t);
    const double load = of(s, "outside.left_tyre_load") * b.speed * b.yaw_rate;
    if (std::hypot(b.x - puddle.x, b.y - puddle.y) < o.puddle_radius_m)
      slip += of(s, "wheels0.wet_patch");
    const double grown = 1.0 + of(s, "wheels0.radius_speed") * speed;
    true_left += (slip + load) * (moved - across) / (r_left * grown);
    true_right += slip * (moved + across) / (r_right * grown);
    wheels.left.push_back(true_left + eccentric * std::sin(true_left));
    wheels.right.push_back(true_right + eccentric * std::sin(true_right));
  }
  return wheels;
}

double value_at(const std::vector<double>& values, double t_s) {
  const double u = std::clamp(t_s / kTick, 0.0, static_cast<double>(values.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(u), values.size() - 2);
  return values[i] + (u - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

std::vector<WheelReading> read_wheels(const std::vector<Moment>& drive,
                                      const HiddenDriveOptions& o,
                                      const WheelModel& m,
                                      double end_s) {
  const Secret& s = o.secret;
  const Wheels wheels = roll(drive, o, m);
  NoiseSource left(o, "wheels0", 1), right(o, "wheels0", 2), steering(o, "steering0", 3);
  std::vector<WheelReading> readings;
  for (int k = 0; 0.02 * k <= end_s; ++k) {
    const double seen = 0.02 * k - of(s, "wheels0.latency");
    const Moment now = moment_at(drive, seen);
    WheelReading r;
    r.t_ns = stamp(0.02 * k, of(s, "clock.drift"));
    r.left_angle_rad = value_at(wheels.left, seen) + m.sigma_angle_rad * left.next(now);
    r.right_angle_rad = value_at(wheels.right, seen) + m.sigma_angle_rad * right.next(now);
    const Moment then = moment_at(drive, seen - of(s, "steering0.latency"));
    const double grown = 1.0 + of(s, "steering0.understeer") * then.speed * then.speed;
    const double curve = (1.0 + of(s, "steering0.wheelbase")) * std::tan(then.steering);
    const double angle = std::atan(kept_of_turn(s) * curve) * grown;
    r.steering_rad = angle * (1.0 + of(s, "steering0.ratio")) + of(s, "steering0.offset") +
                     of(s, "outside.steering_by_speed") * then.speed +
                     o.steering_sigma_rad * steering.next(now);
    if (o.steering_step_rad > 0.0)
      r.steering_rad = o.steering_step_rad * std::round(*r.steering_rad / o.steering_step_rad);
    readings.push_back(r);
  }
  return readings;
}

// Directions of the axes of an IMU in the vehicle frame.
struct TiltedAxes {
  std::array<double, 3> front, left, up;
};

// Rolled about the front axis (right side down), then lifted at its front.
TiltedAxes tilted_axes(double roll, double pitch) {
  const auto lifted = [&](double x, double y, double z) {
    return std::array<double, 3>{x * std::cos(pitch) - z * std::sin(pitch), y,
                                 x * std::sin(pitch) + z * std::cos(pitch)};
  };
  return {lifted(1.0, 0.0, 0.0), lifted(0.0, std::cos(roll), std::sin(roll)),
          lifted(0.0, -std::sin(roll), std::cos(roll))};
}

double along(const std::array<double, 3>& axis, const std::array<double, 3>& vector) {
  return axis[0] * vector[0] + axis[1] * vector[1] + axis[2] * vector[2];
}

std::vector<ImuReading> read_imu(const std::vector<Moment>& drive,
                                 const HiddenDriveOptions& o,
                                 double end_s) {
  const Secret& s = o.secret;
  NoiseSource gyro(o, "imu0", 4);
  Random random(o.seed, "imu axes");
  std::vector<ImuReading> readings;
  for (int k = 0; 0.01 * k <= end_s; ++k) {
    const Moment now = moment_at(drive, 0.01 * k - of(s, "imu0.latency"));
    const double acting = o.acting(0.01 * k);
    const double scale = of(s, "imu0.gyro_scale") + of(s, "outside.gyro_scale_by_column") * acting;
    const double bias = of(s, "imu0.gyro_bias") + of(s, "outside.gyro_bias_by_column") * acting;
    ImuReading r;
    r.t_ns = stamp(0.01 * k, of(s, "clock.drift"));
    const TiltedAxes axes = tilted_axes(of(s, "imu0.tilt_roll"), of(s, "imu0.tilt_pitch"));
    // In a left bend the left side hangs down.
    const double roll = now.yaw_rate > 0.0 ? -bank_of(s) : bank_of(s);
    const double turn = now.yaw_rate * (1.0 + scale);
    const std::array<double, 3> rate{0.0, turn * std::sin(roll), turn * std::cos(roll)};
    const double aside = now.speed * now.yaw_rate;
    const std::array<double, 3> force{now.acceleration,
                                      aside * std::cos(roll) + 9.81 * std::sin(roll),
                                      9.81 * std::cos(roll) - aside * std::sin(roll)};
    r.angular_velocity_rad_s = {along(axes.front, rate) + 0.002 * random.normal(),
                                along(axes.left, rate) + 0.002 * random.normal(),
                                along(axes.up, rate) + bias +
                                    of(s, "outside.gyro_warming") * (0.01 * k) +
                                    0.002 * gyro.next(now)};
    r.specific_force_m_s2 = {along(axes.front, force) + 0.03 * random.normal(),
                             along(axes.left, force) + 0.03 * random.normal(),
                             along(axes.up, force) + 0.03 * random.normal()};
    readings.push_back(r);
  }
  return readings;
}

std::vector<TimedPose> read_poses(const std::vector<Moment>& drive,
                                  const HiddenDriveOptions& o,
                                  double end_s) {
  const Secret& s = o.secret;
  NoiseSource x_noise(o, "poses", 5), y_noise(o, "poses", 6), heading_noise(o, "poses", 7);
  const Moment start = moment_at(drive, -of(s, "cam.latency"));
  std::vector<TimedPose> poses;
  for (int k = 0; 0.08 * k <= end_s; ++k) {
    const Moment now = moment_at(drive, 0.08 * k - of(s, "cam.latency"));
    const double ahead = of(s, "cam.position");
    const double dx = now.x + ahead * std::cos(now.heading) - start.x;
    double dy = now.y + ahead * std::sin(now.heading) - start.y;
    dy += 0.5 * of(s, "map.bend") * dx * dx;
    const double c = std::cos(now.heading);
    double heading = now.heading - of(s, "cam.rotation") + of(s, "map.bend") * dx * c * c;
    heading += of(s, "outside.compass") * std::sin(now.heading);
    const double grown = 1.0 + of(s, "map.scale");
    TimedPose p;
    p.t_ns = stamp(0.08 * k);
    p.T_world_vehicle =
        Eigen::Translation3d(start.x + grown * dx + o.pose_sigma_m * x_noise.next(now),
                             start.y + grown * dy + o.pose_sigma_m * y_noise.next(now), 0.0) *
        Eigen::AngleAxisd(heading + o.pose_sigma_rad * heading_noise.next(now),
                          Eigen::Vector3d::UnitZ());
    poses.push_back(p);
  }
  return poses;
}

}  // namespace

Recording record_drive(const HiddenDriveOptions& options) {
  Recording recording;
  WheelModel& model = recording.wheel_model;
  model.radius_left_m = model.radius_right_m = 0.31;
  model.track_width_m = 1.55;
  model.wheelbase_m = 2.65;
  const auto drive = options.oval
                         ? drive_oval(options.seed, options.length_m, model.wheelbase_m)
                         : drive_car_park(options.seed, options.straight ? 60.0 : options.length_m,
                                          model.wheelbase_m, options.straight);
  const double end_s = kTick * static_cast<double>(drive.size() - 1);
  recording.wheels = read_wheels(drive, options, model, end_s);
  recording.imu = read_imu(drive, options, end_s);
  recording.poses = read_poses(drive, options, end_s);
  return recording;
}

void write_recording(const Recording& recording, const std::filesystem::path& folder) {
  DriveWriterOptions options;
  options.wheel_rate_hz = 50.0;
  options.overwrite = true;
  DriveWriter writer(folder, {}, recording.wheel_model, options);
  for (const auto& r : recording.wheels) writer.write_wheels(r);
  for (const auto& r : recording.imu) writer.write_imu(r);
  writer.write_truth(recording.poses);
  writer.finish();
}

const std::vector<EffectRange>& practical_ranges() {
  static const std::vector<EffectRange> kRanges{
      {"wheels0.left_radius", 0.003, 0.02},
      {"wheels0.right_radius", 0.003, 0.02},
      {"wheels0.radius", 0.003, 0.02},
      {"wheels0.radius_difference", 0.002, 0.01},
      {"wheels0.track_width", 0.01, 0.05},
      {"wheels0.locked_axle", 0.9, 1.0, true},
      {"wheels0.latency", 0.005, 0.08},
      {"wheels0.slip_acceleration", 0.002, 0.01},
      {"wheels0.radius_speed", 0.001, 0.005},
      {"wheels0.eccentricity", 0.005, 0.02},
      {"wheels0.wet_patch", 0.02, 0.10},
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
      {"ground.bank", 0.004, 0.094, true},  // 5 to 25 degrees
      {"map.scale", 0.003, 0.02},
      {"map.bend", 5e-5, 3e-4},
      {"wheels0.outliers", 0.01, 0.1, true},
      {"wheels0.variance(speed)", 0.2, 0.8, true},
      {"wheels0.variance(turn)", 2.0, 8.0, true},
      {"imu0.outliers", 0.01, 0.1, true},
      {"poses.outliers", 0.01, 0.1, true},
      {"poses.variance(speed)", 0.2, 0.8, true},
      {"imu0.variance(turn)", 2.0, 8.0, true},
      {"poses.correlation", 0.2, 0.9, true},
      {"imu0.correlation", 0.2, 0.9, true},
  };
  return kRanges;
}

const std::vector<OutsideEffect>& outside_effects() {
  static const std::vector<OutsideEffect> kOutside{
      {{"outside.gyro_warming", 5e-5, 3e-4}, {{"imu0.yaw_rate", "time"}}},
      {{"outside.steering_by_speed", 0.003, 0.02}, {{"steering0.angle", "speed"}}},
      {{"outside.tyre_warming", 5e-5, 3e-4}, {{"wheels0.scale", "time"}}},
      {{"outside.compass", 0.003, 0.02}, {{"poses.heading", "heading"}}},
      {{"outside.left_tyre_load", 0.004, 0.02},
       {{"wheels0.left_scale", "lateral acceleration"}, {"wheels0.left_scale", "yaw rate"}}},
  };
  return kOutside;
}

HiddenDriveOptions drive_with_lasting_errors(double time_s, std::uint64_t seed) {
  constexpr double kPoseStepS = 0.08;
  constexpr double kDegree = 3.14159265358979323846 / 180.0;
  Random random(seed, "lasting " + std::to_string(time_s));
  HiddenDriveOptions options;
  options.seed = random() >> 1U;
  options.pose_sigma_m = 0.01 * std::pow(50.0, random.uniform());
  options.pose_sigma_rad = 0.03 * kDegree * std::pow(0.5 / 0.03, random.uniform());
  options.secret["poses.correlation"] = std::exp(-kPoseStepS / time_s);
  return options;
}

double draw_size(const EffectRange& range, std::uint64_t seed) {
  Random random(seed, "size " + range.name);
  const double size = range.low * std::pow(range.high / range.low, random.uniform());
  const bool negative = random.uniform() < 0.5;
  return negative && !range.positive ? -size : size;
}

}  // namespace roadbook::test
