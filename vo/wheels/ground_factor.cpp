#include <algorithm>
#include <cmath>

#include "vo/ground_scale.hpp"
#include "vo/wheels/wheel_doubts.hpp"

namespace roadbook {
namespace {

constexpr double kAhead_m = 1.5;
constexpr double kBeside_m = 1.6;
constexpr std::size_t kReachKeyframes =
    60;  // keyframes in which the car gets to a corner that it sees

// Height of a corner in the frame of the vehicle pose nearest to it. Empty where none is near.
std::optional<double> height_beside(const VoResult& odometry, const Track& track) {
  const auto first = static_cast<std::size_t>(track.observations.front().keyframe);
  const std::size_t end = std::min(odometry.keyframes.size(), first + kReachKeyframes);
  double best = std::hypot(kAhead_m, kBeside_m);
  std::optional<double> height;
  for (std::size_t k = first; k < end; ++k) {
    if (k > first && odometry.keyframes[k].after_gap) break;
    const Eigen::Vector3d p = odometry.keyframes[k].T_odom_vehicle.inverse() * *track.p_odom;
    if (std::abs(p.x()) > kAhead_m || std::abs(p.y()) > kBeside_m) continue;
    if (p.head<2>().norm() >= best) continue;
    best = p.head<2>().norm();
    height = p.z();
  }
  return height;
}

}  // namespace

std::optional<double> ground_factor(const VoResult& odometry, double camera_height_m) {
  constexpr int kFewest = 100;
  std::vector<double> ratios;
  for (const Track& track : odometry.tracks) {
    if (!track.p_odom) continue;
    const auto height = height_beside(odometry, track);
    if (height && *height < 0.95 * camera_height_m)
      ratios.push_back(camera_height_m / (camera_height_m - *height));
  }
  const auto found = ground_scale(std::move(ratios), kFewest);
  if (!found) return std::nullopt;
  return found->scale;
}

}  // namespace roadbook
