#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "base/random.hpp"
#include "base/se3.hpp"
#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook::test {

// A drive in bends, as its wheels count it and as cameras alone see it.

inline constexpr double kSpeed_m_s = 2.0;  // [m/s]
inline constexpr double kBend_m = 8.0;     // [m]: bends left and right in turn
inline constexpr double kDriven_s = 40.0;
inline constexpr double kSightScale = 1.1;  // cameras alone know lengths up to a factor

inline double curvature(double s) {
  return std::fmod(s, 20.0) < 10.0 ? 1.0 / kBend_m : -1.0 / kBend_m;
}

// Angles of the wheels every 20 ms, by hand: each rolls on its own circle.
inline std::vector<WheelReading> readings_of(const WheelModel& model) {
  std::vector<WheelReading> readings;
  double left = 0.0;
  double right = 0.0;
  for (int i = 0; i <= 50 * static_cast<int>(kDriven_s); ++i) {
    readings.push_back({std::int64_t{i} * 20'000'000, left, right, std::nullopt});
    const double step = kSpeed_m_s * 0.02;
    const double across = 0.5 * model.track_width_m * curvature(kSpeed_m_s * 0.02 * i);
    left += step * (1.0 - across) / model.radius_left_m;
    right += step * (1.0 + across) / model.radius_right_m;
  }
  return readings;
}

// Odometry of the cameras alone: a keyframe every 0.1 s, with noise and a wrong scale.
inline VoResult sight_of(double scale = kSightScale) {
  Random random(11, "sight");
  VoResult sight;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 10 * static_cast<int>(kDriven_s); ++i) {
    VoKeyframe keyframe;
    keyframe.t_ns = std::int64_t{i} * 100'000'000;
    keyframe.T_odom_vehicle = T;
    keyframe.inliers = 200;
    sight.keyframes.push_back(keyframe);
    for (int part = 0; part < 5; ++part) {
      const double s = kSpeed_m_s * (0.1 * i + 0.02 * part);
      T = T * pose_from_planar(scale * kSpeed_m_s * 0.02, 0.0, kSpeed_m_s * 0.02 * curvature(s));
    }
    T = T * pose_from_planar(random.normal(0.0, 0.003), random.normal(0.0, 0.003),
                             random.normal(0.0, 0.001));
  }
  return sight;
}

// Keeps angles as they were at `from_s` for some seconds; then they continue from there.
inline void hold(
    std::vector<WheelReading>& readings, double from_s, double seconds, bool left, bool right) {
  const auto first = static_cast<std::size_t>(from_s * 50.0);
  const auto last = static_cast<std::size_t>((from_s + seconds) * 50.0);
  const double lost_left = readings[last].left_angle_rad - readings[first].left_angle_rad;
  const double lost_right = readings[last].right_angle_rad - readings[first].right_angle_rad;
  for (std::size_t i = first; i < readings.size(); ++i) {
    if (left) {
      double& angle = readings[i].left_angle_rad;
      angle = i < last ? readings[first].left_angle_rad : angle - lost_left;
    }
    if (right) {
      double& angle = readings[i].right_angle_rad;
      angle = i < last ? readings[first].right_angle_rad : angle - lost_right;
    }
  }
}

}  // namespace roadbook::test
