#include "diagnosis/streams/noise.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/streams/coarse_readings.hpp"

namespace roadbook {
namespace {

// Standard deviation of a window's mean for white noise; 0 if it cannot be determined.
double scatter_of_mean(const std::vector<WindowObservation>& windows) {
  double sum = 0.0;
  double freedom = 0.0;
  for (const auto& w : windows) {
    if (w.count < 3) continue;
    const auto n = static_cast<double>(w.count);
    sum += w.squares / n;
    freedom += n - 2.0;
  }
  return freedom < 100.0 ? 0.0 : std::sqrt(sum / freedom);
}

// Lower bounds of sensor noise: quantised readings scatter less than their error.
constexpr double kLeastSteering = 1e-4;
constexpr double kLeastGyro = 5e-5;

}  // namespace

double& MotionNoise::sigma(Channel channel) {
  switch (channel) {
    case Channel::kSteering:
      return steering_rad;
    case Channel::kGyro:
      return gyro_rad_s;
    case Channel::kPoseAlong:
      return pose[0];
    case Channel::kPoseAcross:
      return pose[1];
    case Channel::kPoseHeading:
      return pose[2];
    default:
      break;
  }
  ROADBOOK_ASSERT(!"a channel that is read directly");
  return pose[0];
}

double MotionNoise::sigma(Channel channel) const {
  MotionNoise copy = *this;
  return copy.sigma(channel);
}

MotionNoise stated_noise(const Observations& obs) {
  MotionNoise noise;
  const WheelModel& wheels = obs.wheel_model;
  // A stated sigma of 0 means that nothing is stated.
  const auto start_from = [](double& sigma, double stated) {
    if (stated > 0.0) sigma = stated;
  };
  start_from(noise.wheel_angle_rad, wheels.sigma_angle_rad);
  start_from(noise.distance_per_sqrt_m, wheels.sigma_distance_per_sqrt_m);
  start_from(noise.heading_per_sqrt_m, wheels.sigma_heading_per_sqrt_m);
  noise.steering_rad = std::max(
      {scatter_of_mean(obs.steering), kLeastSteering, rounding_sigma(obs.steering_step_rad)});
  noise.gyro_rad_s =
      std::max({scatter_of_mean(obs.gyro), kLeastGyro, rounding_sigma(obs.gyro_step_rad_s)});
  return noise;
}

MotionNoise loosened(const MotionNoise& noise) {
  constexpr double kRougher = 6.0;
  MotionNoise loose = noise;
  loose.speed_m_s *= kRougher;
  loose.yaw_rad_s *= kRougher;
  return loose;
}

}  // namespace roadbook
