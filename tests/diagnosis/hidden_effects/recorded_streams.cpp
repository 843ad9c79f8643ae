#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

#include <cmath>

namespace roadbook::test {

MotionStreams streams_of(const Recording& recording) {
  MotionStreams streams;
  streams.wheel_model = recording.wheel_model;
  const std::int64_t origin = recording.poses.front().t_ns;
  const auto seconds = [origin](std::int64_t t) { return 1e-9 * static_cast<double>(t - origin); };
  for (const auto& p : recording.poses) {
    const Eigen::Matrix3d R = p.T_world_vehicle.linear();
    streams.poses.push_back({seconds(p.t_ns), p.T_world_vehicle.translation().x(),
                             p.T_world_vehicle.translation().y(), std::atan2(R(1, 0), R(0, 0))});
  }
  for (const auto& w : recording.wheels) {
    streams.wheels.push_back({seconds(w.t_ns), w.left_angle_rad, w.right_angle_rad});
    streams.steering.push_back({seconds(w.t_ns), *w.steering_rad});
  }
  for (const auto& g : recording.imu) {
    streams.gyro.push_back({seconds(g.t_ns), g.angular_velocity_rad_s.z()});
    streams.imu.push_back({seconds(g.t_ns), g.angular_velocity_rad_s, g.specific_force_m_s2});
  }
  return streams;
}

}  // namespace roadbook::test
