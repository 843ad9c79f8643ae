#include "diagnosis/simulated_again.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "base/random.hpp"
#include "diagnosis/motion/motion_fit.hpp"
#include "diagnosis/reckoning_error.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/shown_unit.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {
namespace {

constexpr std::uint64_t kDrives = 4;
constexpr std::size_t kFewestRows = 40;
constexpr unsigned kAllStreams = kWheels | kSteeringBit | kGyroBit | kPoses;

// A way that wheels and gyro reckon would hide their own errors.
std::vector<double> innovations_of(const Observations& obs, const EffectSizes& known) {
  return row_residuals(obs, smoothed(trajectory_of_lines(obs)), motion_effects_of(known));
}

// Of one channel, in the unit of reports.
std::vector<double> rows_of(const Observations& obs,
                            const std::vector<double>& all,
                            Channel channel) {
  const auto first = obs.offsets();
  const std::size_t c = index_of(channel);
  std::vector<double> rows(all.begin() + static_cast<std::ptrdiff_t>(first[c]),
                           all.begin() + static_cast<std::ptrdiff_t>(first[c + 1]));
  const double factor = shown_unit(obs, channel).factor;
  for (double& row : rows) row *= factor;
  return rows;
}

// Readings of several drives, one after the other.
struct Simulated {
  std::vector<Observations> drives;
  std::vector<std::vector<double>> innovations;

  Simulated(const Observations& obs,
            const EffectSizes& known,
            const EffectSizes& effects,
            const MotionNoise& noise) {
    for (std::uint64_t seed = 0; seed < kDrives; ++seed) {
      drives.push_back(simulated_again(obs, effects, noise, seed));
      innovations.push_back(innovations_of(drives.back(), known));
    }
  }
  [[nodiscard]] std::vector<double> rows(Channel channel) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < drives.size(); ++i)
      for (const double row : rows_of(drives[i], innovations[i], channel)) all.push_back(row);
    return all;
  }
  [[nodiscard]] std::vector<double> reckoned(const EffectSizes& known) const {
    std::vector<double> all;
    for (const Observations& drive : drives)
      for (const double error : reckoning_errors_m(drive, known, known))
        all.push_back(100.0 * error);
    return all;
  }
};

}  // namespace

Observations simulated_again(const Observations& obs,
                             const EffectSizes& effects,
                             const MotionNoise& noise,
                             std::uint64_t seed) {
  const Trajectory along = smoothed(trajectory_of_poses(obs));
  const std::vector<double> rows =
      predict_rows(obs, along, motion_effects_of(effects), kAllStreams, &along);
  const auto first = obs.offsets();
  const auto row = [&](Channel channel, std::size_t i) {
    return rows[first[index_of(channel)] + i];
  };
  Observations drawn = obs;
  // A stream's draws do not depend on how many the others take.
  Random of_wheels(seed, "again wheels"), of_steering(seed, "again steering"),
      of_gyro(seed, "again gyro"), of_poses(seed, "again poses");
  std::array<StreamNoise, 2> wheels{StreamNoise(effects, "wheels0"),
                                    StreamNoise(effects, "wheels0")};
  const bool both = obs.rows(Channel::kWheelHeading) > 0;
  const WheelModel& model = obs.wheel_model;
  const double radius = 0.5 * (model.radius_left_m + model.radius_right_m);
  double distance = 0.0, heading = 0.0;
  std::array<double, 2> last{};
  for (std::size_t i = 0; i < obs.wheels.size(); ++i) {
    const MotionState s = along.rates_at(obs.wheels[i].t_s);
    std::array<double, 2> angle{};
    for (std::size_t w = 0; w < 2; ++w)
      angle[w] = noise.wheel_angle_rad * radius * wheels[w].next(of_wheels, s.speed, s.yaw_rate);
    if (i > 0) {
      const double ds = row(Channel::kWheelDistance, i - 1);
      const double root =
          std::sqrt(std::abs(ds)) *
          noise_growth(noise_imperfections(effects, "wheels0"), s.speed, s.yaw_rate);
      distance += ds + noise.distance_per_sqrt_m * root * of_wheels.normal() +
                  (both ? 0.5 * (angle[0] - last[0] + angle[1] - last[1]) : angle[0] - last[0]);
      if (both)
        heading += row(Channel::kWheelHeading, i - 1) +
                   noise.heading_per_sqrt_m * root * of_wheels.normal() +
                   (angle[1] - last[1] - angle[0] + last[0]) / model.track_width_m;
    }
    last = angle;
    drawn.wheels[i].distance_m = obs.wheels.front().distance_m + distance;
    drawn.wheels[i].heading = obs.wheels.front().heading + heading;
  }
  StreamNoise steering(effects, "steering0");
  for (std::size_t i = 0; i < obs.steering.size(); ++i) {
    const MotionState s = along.rates_at(obs.steering[i].begin_s);
    drawn.steering[i].value = row(Channel::kSteering, i) +
                              noise.steering_rad * steering.next(of_steering, s.speed, s.yaw_rate);
  }
  StreamNoise gyro(effects, "imu0");
  for (std::size_t i = 0; i < obs.gyro.size(); ++i) {
    const MotionState s = along.rates_at(obs.gyro[i].begin_s);
    drawn.gyro[i].value =
        row(Channel::kGyro, i) + noise.gyro_rad_s * gyro.next(of_gyro, s.speed, s.yaw_rate);
  }
  std::array<StreamNoise, 3> poses{StreamNoise(effects, "poses"), StreamNoise(effects, "poses"),
                                   StreamNoise(effects, "poses")};
  const double scale = noise.poses_are_exact() ? 0.0 : 1.0;
  for (std::size_t i = 0; i < obs.poses.size(); ++i) {
    const MotionState s = along.at(obs.poses[i].t_s);
    std::array<double, 3> off{};
    for (std::size_t k = 0; k < 3; ++k)
      off[k] = scale * noise.pose[k] * poses[k].next(of_poses, s.speed, s.yaw_rate);
    const double at = obs.poses_have_heading ? row(Channel::kPoseHeading, i) : s.heading;
    drawn.poses[i].x = row(Channel::kPoseAlong, i) + off[0] * std::cos(at) - off[1] * std::sin(at);
    drawn.poses[i].y = row(Channel::kPoseAcross, i) + off[0] * std::sin(at) + off[1] * std::cos(at);
    drawn.poses[i].heading = at + off[2];
  }
  return drawn;
}

std::vector<StreamComparison> compare_with_simulation(const Observations& obs,
                                                      const EffectSizes& known,
                                                      const EffectSizes& found,
                                                      const MotionNoise& noise) {
  const std::vector<double> recorded = innovations_of(obs, known);
  const Simulated stated(obs, known, known, noise);
  std::optional<Simulated> extended;
  if (found != known) extended.emplace(obs, known, found, noise);
  std::vector<StreamComparison> all;
  for (std::size_t i = 0; i < kChannels; ++i) {
    const auto channel = static_cast<Channel>(i);
    const std::vector<double> rows = rows_of(obs, recorded, channel);
    if (rows.size() < kFewestRows) continue;
    StreamComparison c;
    c.stream = std::string(stream_of(channel));
    c.channel = std::string(name_of(channel));
    c.unit = shown_unit(obs, channel).name;
    c.rows = rows.size();
    c.recorded = moments_of(rows);
    c.stated = compare_samples(rows, stated.rows(channel));
    if (extended) c.extended = compare_samples(rows, extended->rows(channel));
    all.push_back(std::move(c));
  }
  std::vector<double> reckoned = reckoning_errors_m(obs, known, known);
  for (double& error : reckoned) error *= 100.0;
  const std::vector<double> as_stated = stated.reckoned(known);
  const std::vector<double> with_effects =
      extended ? extended->reckoned(known) : std::vector<double>{};
  if (reckoned.size() < 3 || as_stated.size() < 3) return all;
  StreamComparison c;
  c.stream = "dead reckoning";
  c.channel = "error after 5 s";
  c.unit = "cm";
  c.rows = reckoned.size();
  c.recorded = moments_of(reckoned);
  c.stated = compare_samples(reckoned, as_stated);
  if (with_effects.size() >= 3) c.extended = compare_samples(reckoned, with_effects);
  all.push_back(std::move(c));
  return all;
}

}  // namespace roadbook
