#include "diagnosis/streams/drive_streams.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "diagnosis/streams/level_motion.hpp"

namespace roadbook {

MotionStreams motion_streams(const Drive& drive) { return motion_streams(drive, drive.truth()); }

MotionStreams motion_streams(const Drive& drive, const std::vector<TimedPose>& reference) {
  MotionStreams streams;
  if (reference.empty()) return streams;
  const std::int64_t origin = reference.front().t_ns;
  const auto seconds = [origin](std::int64_t t_ns) {
    return 1e-9 * static_cast<double>(t_ns - origin);
  };
  std::vector<Attitude> body;
  std::vector<double> heights;
  for (const TimedPose& p : reference) {
    const Eigen::Matrix3d R = p.T_world_vehicle.linear();
    heights.push_back(p.T_world_vehicle.translation().z());
    body.push_back({seconds(p.t_ns), std::atan2(R(2, 0), std::hypot(R(0, 0), R(1, 0))),
                    std::atan2(R(2, 1), R(2, 2))});
    streams.poses.push_back({seconds(p.t_ns), p.T_world_vehicle.translation().x(),
                             p.T_world_vehicle.translation().y(), std::atan2(R(1, 0), R(0, 0))});
  }
  if (drive.wheel_model()) {
    streams.wheel_model = *drive.wheel_model();
    const double offset = streams.wheel_model.time_offset_s;
    drive.for_each_wheel_reading([&](const WheelReading& r) {
      const double t = seconds(r.t_ns) + offset;
      streams.wheels.push_back({t, r.left_angle_rad, r.right_angle_rad});
      if (r.steering_rad) streams.steering.push_back({t, *r.steering_rad});
    });
  }
  PitchRates pitch_rates;
  drive.for_each_imu_reading([&](const ImuReading& r) {
    streams.gyro.push_back({seconds(r.t_ns), r.angular_velocity_rad_s.z()});
    pitch_rates.push_back({seconds(r.t_ns), r.angular_velocity_rad_s.y()});
    streams.imu.push_back({seconds(r.t_ns), r.angular_velocity_rad_s, r.specific_force_m_s2});
  });
  // The body may be mounted off level: the slope under the wheels is that of the way.
  std::vector<Attitude> road = slopes_of(streams.poses, heights);
  for (std::size_t i = 0; i < road.size(); ++i) road[i].bank_rad = body[i].bank_rad;
  level_motion(road, body, pitch_rates, streams);
  // A planar reference has a roll of exactly 0, or of rounding.
  constexpr double kRounding = 1e-6;
  streams.bank_is_known = std::any_of(
      body.begin(), body.end(), [](const Attitude& a) { return std::abs(a.bank_rad) > kRounding; });
  streams.body = std::move(body);
  LoggedColumn temperature{"temperature", "degC", {}, {}};
  drive.for_each_friction_reading([&](const FrictionReading& r) {
    if (!r.temperature_c) return;
    temperature.t_s.push_back(seconds(r.t_ns));
    temperature.values.push_back(*r.temperature_c);
  });
  // A constant temperature is reported by the friction diagnosis, which owns the column.
  const auto& t = temperature.values;
  if (std::adjacent_find(t.begin(), t.end(), std::not_equal_to<>()) != t.end())
    streams.columns.push_back(std::move(temperature));
  return streams;
}

bool records_motion(const MotionStreams& streams) {
  return !streams.wheels.empty() || !streams.steering.empty() || !streams.gyro.empty();
}

}  // namespace roadbook
