#include "diagnosis/streams/motion_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

// Slip and eccentricity are nonlinear. Readings are one knot interval apart, so the mean motion
// between two of them is used.
void predict_wheels(const Observations& obs,
                    const Trajectory& trajectory,
                    const Trajectory& smooth,
                    const MotionEffects& effects,
                    const std::vector<double>& times,
                    std::vector<double>& rows) {
  const auto first = obs.offsets();
  double* distance = rows.data() + first[index_of(Channel::kWheelDistance)];
  double* heading = rows.data() + first[index_of(Channel::kWheelHeading)];
  MotionState before = trajectory.rates_at(times.front());
  for (std::size_t k = 1; k < times.size(); ++k) {
    const MotionState now = trajectory.rates_at(times[k]);
    TrueMotion<double> motion;
    motion.distance_m = now.distance_m - before.distance_m;
    motion.turn_rad = now.turned - before.turned;
    const double dt = times[k] - times[k - 1];
    motion.speed = motion.distance_m / dt;
    if (effects.wheels.slip_acceleration != 0.0)
      motion.acceleration =
          (smooth.rates_at(times[k]).speed - smooth.rates_at(times[k - 1]).speed) / dt;
    motion.left_phase_rad = obs.wheels[k - 1].left_rad;
    motion.right_phase_rad = obs.wheels[k - 1].right_rad;
    const Eigen::Vector2d read =
        predict_wheel_row(obs.wheel_model, obs.wheels_read, effects, motion);
    distance[k - 1] = read.x();
    if (obs.wheels_read == WheelsRead::kBoth) heading[k - 1] = read.y();
    before = now;
  }
}

void predict_poses(const Observations& obs,
                   const Trajectory& trajectory,
                   const MotionEffects& effects,
                   const std::vector<double>& times,
                   const std::array<double*, 3>& rows) {
  const PlanarPose<double> origin{obs.poses.front().x, obs.poses.front().y, 0.0};
  for (std::size_t k = 0; k < times.size(); ++k) {
    const MotionState s = trajectory.at(times[k]);
    const auto read = predict_pose(effects.pose, PlanarPose<double>{s.x, s.y, s.heading}, origin);
    rows[0][k] = read.x;
    rows[1][k] = read.y;
    if (obs.poses_have_heading) rows[2][k] = read.heading;
  }
}

}  // namespace

double least_steering_speed(const Trajectory& trajectory) {
  double squares = 0.0;
  for (const double v : trajectory.speed) squares += v * v;
  return std::min(0.4, 0.5 * std::sqrt(squares / static_cast<double>(trajectory.knots())));
}

double true_time(double stamp_s, double origin_s, double drift, double latency_s) {
  return origin_s + (stamp_s - origin_s) / (1.0 + drift) - latency_s;
}

RowTimes row_times(const Observations& obs, const MotionEffects& effects) {
  RowTimes times;
  const auto wheels = [&](double t) {
    return true_time(t, obs.origin_s, effects.clock_drift, effects.wheels.latency);
  };
  const auto imu = [&](double t) {
    return true_time(t, obs.origin_s, effects.clock_drift, effects.imu.latency);
  };
  for (const auto& w : obs.wheels) times.wheels.push_back(wheels(w.t_s));
  for (const auto& s : obs.steering) {
    times.steering_begin.push_back(wheels(s.begin_s) - effects.steering.latency);
    times.steering_end.push_back(wheels(s.end_s) - effects.steering.latency);
  }
  for (const auto& g : obs.gyro) {
    times.gyro_begin.push_back(imu(g.begin_s));
    times.gyro_end.push_back(imu(g.end_s));
  }
  for (const auto& p : obs.poses)
    times.poses.push_back(true_time(p.t_s, obs.origin_s, 0.0, effects.pose.latency));
  return times;
}

std::vector<double> predict_rows(const Observations& obs,
                                 const Trajectory& trajectory,
                                 const MotionEffects& effects,
                                 unsigned streams,
                                 const Trajectory* smooth) {
  const auto first = obs.offsets();
  std::vector<double> rows(first.back(), 0.0);
  const auto at = [&](Channel channel) { return rows.data() + first[index_of(channel)]; };
  const RowTimes times = row_times(obs, effects);
  if ((streams & kWheels) != 0 && obs.wheels.size() > 1)
    predict_wheels(obs, trajectory, smooth == nullptr ? trajectory : *smooth, effects, times.wheels,
                   rows);
  if ((streams & kSteeringBit) != 0)
    for (std::size_t k = 0; k < obs.steering.size(); ++k) {
      const MotionState s =
          trajectory.rates_at(0.5 * (times.steering_begin[k] + times.steering_end[k]));
      const double speed = std::copysign(std::max(std::abs(s.speed), 1e-3), s.speed);
      at(Channel::kSteering)[k] = predict_steering(obs.wheel_model.wheelbase_m, effects.steering,
                                                   speed, (1.0 - effects.bank) * s.yaw_rate);
    }
  // The rate at the middle of the window, as in the derivative that the fit uses. Different
  // functions would leak errors of the trajectory into the innovations.
  if ((streams & kGyroBit) != 0)
    for (std::size_t k = 0; k < obs.gyro.size(); ++k)
      at(Channel::kGyro)[k] = predict_gyro(
          effects.imu,
          (1.0 - effects.bank) *
              trajectory.rates_at(0.5 * (times.gyro_begin[k] + times.gyro_end[k])).yaw_rate);
  if ((streams & kPoses) != 0)
    predict_poses(obs, trajectory, effects, times.poses,
                  {at(Channel::kPoseAlong), at(Channel::kPoseAcross), at(Channel::kPoseHeading)});
  return rows;
}

std::vector<double> pose_rows_by_latency(const Observations& obs,
                                         const Trajectory& trajectory,
                                         const MotionEffects& effects) {
  constexpr double kStep = 1e-3;  // [s]
  const auto first = obs.offsets();
  const RowTimes times = row_times(obs, effects);
  const PlanarPose<double> origin{obs.poses.front().x, obs.poses.front().y, 0.0};
  std::vector<double> rows(first.back(), 0.0);
  for (std::size_t k = 0; k < times.poses.size(); ++k) {
    const MotionState s = trajectory.at(times.poses[k]);
    const auto read_after = [&](double later_s) {
      const double way = s.speed * later_s;
      return predict_pose(
          effects.pose,
          PlanarPose<double>{s.x + way * std::cos(s.heading), s.y + way * std::sin(s.heading),
                             s.heading + s.yaw_rate * later_s},
          origin);
    };
    const PlanarPose<double> less = read_after(kStep);
    const PlanarPose<double> more = read_after(-kStep);
    rows[first[index_of(Channel::kPoseAlong)] + k] = (more.x - less.x) / (2.0 * kStep);
    rows[first[index_of(Channel::kPoseAcross)] + k] = (more.y - less.y) / (2.0 * kStep);
    if (obs.poses_have_heading)
      rows[first[index_of(Channel::kPoseHeading)] + k] =
          (more.heading - less.heading) / (2.0 * kStep);
  }
  return rows;
}

void turn_pose_rows(const Observations& obs,
                    const Trajectory& trajectory,
                    const MotionEffects& effects,
                    std::vector<double>& rows) {
  const auto first = obs.offsets();
  double* x = rows.data() + first[index_of(Channel::kPoseAlong)];
  double* y = rows.data() + first[index_of(Channel::kPoseAcross)];
  const RowTimes times = row_times(obs, effects);
  for (std::size_t k = 0; k < obs.poses.size(); ++k) {
    const double psi = trajectory.rates_at(times.poses[k]).heading;
    const double c = std::cos(psi);
    const double s = std::sin(psi);
    const double along = c * x[k] + s * y[k];
    y[k] = -s * x[k] + c * y[k];
    x[k] = along;
  }
}

std::vector<double> row_residuals(const Observations& obs,
                                  const Trajectory& trajectory,
                                  const MotionEffects& effects) {
  const auto first = obs.offsets();
  const Trajectory smooth =
      effects.wheels.slip_acceleration != 0.0 ? smoothed(trajectory) : Trajectory{};
  std::vector<double> r =
      predict_rows(obs, trajectory, effects, kWheels | kSteeringBit | kGyroBit | kPoses, &smooth);
  const auto at = [&](Channel channel) { return r.data() + first[index_of(channel)]; };
  for (std::size_t k = 0; k + 1 < obs.wheels.size(); ++k) {
    const WheelObservation& a = obs.wheels[k];
    const WheelObservation& b = obs.wheels[k + 1];
    double& d = at(Channel::kWheelDistance)[k];
    d = b.distance_m - a.distance_m - d;
    if (obs.wheels_read != WheelsRead::kBoth) continue;
    double& h = at(Channel::kWheelHeading)[k];
    h = b.heading - a.heading - h;
  }
  for (std::size_t k = 0; k < obs.steering.size(); ++k)
    at(Channel::kSteering)[k] = obs.steering[k].value - at(Channel::kSteering)[k];
  for (std::size_t k = 0; k < obs.gyro.size(); ++k)
    at(Channel::kGyro)[k] = obs.gyro[k].value - at(Channel::kGyro)[k];
  for (std::size_t k = 0; k < obs.poses.size(); ++k) {
    at(Channel::kPoseAlong)[k] = obs.poses[k].x - at(Channel::kPoseAlong)[k];
    at(Channel::kPoseAcross)[k] = obs.poses[k].y - at(Channel::kPoseAcross)[k];
    if (obs.poses_have_heading)
      at(Channel::kPoseHeading)[k] = obs.poses[k].heading - at(Channel::kPoseHeading)[k];
  }
  turn_pose_rows(obs, trajectory, effects, r);
  return r;
}

}  // namespace roadbook
