#include "diagnosis/motion/effect_columns.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

std::vector<Channel> channels_of(unsigned streams) {
  std::vector<Channel> channels;
  const auto add = [&](unsigned bit, std::initializer_list<Channel> of) {
    if ((streams & bit) != 0) channels.insert(channels.end(), of);
  };
  add(kWheels, {Channel::kWheelDistance, Channel::kWheelHeading});
  add(kSteeringBit, {Channel::kSteering});
  add(kGyroBit, {Channel::kGyro});
  add(kPoses, {Channel::kPoseAlong, Channel::kPoseAcross, Channel::kPoseHeading});
  return channels;
}

// Change of the rows of an effect's streams per unit of its size.
std::vector<double> rows_by_size(const Observations& obs,
                                 const MotionPoint& smooth,
                                 const MotionEffect& effect) {
  if (effect.name == "cam.latency")
    return pose_rows_by_latency(obs, smooth.trajectory, smooth.effects);
  const double step = 0.02 * declaration_of(effect.name).plausible;
  MotionEffects less = smooth.effects;
  MotionEffects more = smooth.effects;
  effect.size(less) -= step;
  effect.size(more) += step;
  std::vector<double> change = predict_rows(obs, smooth.trajectory, more, effect.streams);
  const std::vector<double> low = predict_rows(obs, smooth.trajectory, less, effect.streams);
  for (std::size_t i = 0; i < change.size(); ++i) change[i] = (change[i] - low[i]) / (2.0 * step);
  return change;
}

// Of each step of the wheels.
std::vector<double> shares_inside(const WheelSteps& wheels, double x, double y, double radius) {
  std::vector<double> shares;
  shares.reserve(wheels.steps.size());
  for (const WheelSteps::Step& s : wheels.steps)
    shares.push_back(share_inside(s, std::hypot(s.x - x, s.y - y), radius));
  return shares;
}

// Wheels that turn more by these shares.
void add_slip(const WheelSteps& wheels, const std::vector<double>& shares, Columns& columns) {
  std::vector<double> distance(shares.size());
  std::vector<double> heading(shares.size());
  for (std::size_t k = 0; k < shares.size(); ++k) {
    distance[k] = shares[k] * wheels.steps[k].distance_m;
    heading[k] = shares[k] * wheels.steps[k].turn_rad;
  }
  columns.add();
  columns.set(Channel::kWheelDistance, std::move(distance));
  columns.set(Channel::kWheelHeading, std::move(heading));
}

}  // namespace

Columns effect_column(const Observations& obs, const MotionPoint& smooth, std::size_t index) {
  const MotionEffect& effect = motion_effects()[index];
  std::vector<double> change = rows_by_size(obs, smooth, effect);
  const auto first = obs.offsets();
  const auto channels = channels_of(effect.streams);
  if ((effect.streams & kPoses) != 0)
    turn_pose_rows(obs, smooth.trajectory, smooth.effects, change);
  Columns columns;
  columns.add();
  for (const Channel c : channels) {
    const auto at = change.begin() + static_cast<std::ptrdiff_t>(first[index_of(c)]);
    columns.set(c, {at, at + static_cast<std::ptrdiff_t>(obs.rows(c))});
  }
  return columns;
}

WheelSteps::WheelSteps(const Observations& obs, const MotionPoint& smooth) {
  const RowTimes times = row_times(obs, smooth.effects);
  for (std::size_t k = 0; k + 1 < obs.wheels.size(); ++k) {
    const MotionState a = smooth.trajectory.at(times.wheels[k]);
    const MotionState b = smooth.trajectory.at(times.wheels[k + 1]);
    TrueMotion<double> motion;
    motion.distance_m = b.distance_m - a.distance_m;
    motion.turn_rad = b.turned - a.turned;
    const Eigen::Vector2d row = predict_wheel_row(obs.wheel_model, obs.wheels_read, {}, motion);
    steps.push_back({0.5 * (a.x + b.x), 0.5 * (a.y + b.y), row.x(), row.y()});
  }
}

double share_inside(const WheelSteps::Step& s, double away, double radius) {
  const double reach = 0.5 * std::abs(s.distance_m) + 1e-6;
  return std::clamp(0.5 + 0.5 * (radius - away) / reach, 0.0, 1.0);
}

Columns place_column(const WheelSteps& wheels, double x, double y, double radius) {
  Columns columns;
  add_slip(wheels, shares_inside(wheels, x, y, radius), columns);
  return columns;
}

Columns disc_columns(const WheelSteps& wheels, const Candidate& disc, double slip) {
  constexpr double kDiscMoves = 0.5;  // [m]
  Columns columns;
  const auto add = [&](double along, double wider) {
    const double dx = along * std::cos(disc.place_heading);
    const double dy = along * std::sin(disc.place_heading);
    std::vector<double> shares =
        shares_inside(wheels, disc.place_x + dx, disc.place_y + dy, disc.place_radius + wider);
    const std::vector<double> less =
        shares_inside(wheels, disc.place_x - dx, disc.place_y - dy, disc.place_radius - wider);
    for (std::size_t k = 0; k < shares.size(); ++k)
      shares[k] = slip * (shares[k] - less[k]) / (2.0 * kDiscMoves);
    add_slip(wheels, shares, columns);
  };
  add(kDiscMoves, 0.0);
  add(0.0, kDiscMoves);
  return columns;
}

}  // namespace roadbook
