#include "vo/wheels/wheel_signs.hpp"

#include <cmath>

#include "vo/wheels/wheel_doubts.hpp"
#include "vo/wheels/wheel_tolerance.hpp"

namespace roadbook {
namespace {

// Half of the cameras or more showed enough corners in two successive keyframes, but hardly one
// agreed with a motion near that of the wheels.
bool is_lost(const VoKeyframe& before, const VoKeyframe& now) {
  std::size_t corners = 0;
  std::size_t cameras = 0;
  for (std::size_t c = 0; c < now.features.size(); ++c) {
    if (before.features[c].size() == 0 || now.features[c].size() == 0) continue;
    corners += now.features[c].size();
    ++cameras;
  }
  return now.inliers < kFewestInliers && corners >= 4 * kFewestInliers &&
         2 * cameras >= now.features.size();
}

// Keyframes whose sum of turns differs between the cameras and the wheels.
std::vector<TimeSpan> wrong_turns(const VoResult& odometry, const WheelOdometry& wheels) {
  constexpr std::size_t kSummed = 8;  // keyframes
  const auto& keyframes = odometry.keyframes;
  std::vector<TimeSpan> spans;
  double turned = 0.0;
  double beyond = 0.0;
  std::size_t known_from = 0;  // wheels know all motions since this keyframe
  for (std::size_t k = 1; k < keyframes.size(); ++k) {
    if (!keyframes[k].wheels) {
      turned = beyond = 0.0;
      known_from = k;
      continue;
    }
    beyond += keyframes[k].turn_beyond_wheels_rad;
    turned += keyframes[k].wheels->motion.z();
    if (k - known_from > kSummed) {
      beyond -= keyframes[k - kSummed].turn_beyond_wheels_rad;
      turned -= keyframes[k - kSummed].wheels->motion.z();
    }
    const std::size_t first = std::max(known_from, k - std::min(k, kSummed));
    const auto moved = wheels.between(keyframes[first].t_ns, keyframes[k].t_ns);
    if (!moved) continue;
    const double usual = kOfTurn * turned;
    const double sigma =
        std::sqrt(moved->covariance(2, 2) + kLeastTurn_rad * kLeastTurn_rad + usual * usual);
    if (std::abs(beyond) > kWheelSigmas * sigma)
      add_span(spans, keyframes[first].t_ns, keyframes[k].t_ns);
  }
  return spans;
}

}  // namespace

WheelSigns find_wheel_signs(const VoResult& odometry,
                            const WheelOdometry& wheels,
                            double camera_height_m) {
  constexpr double kScaleOff = 0.08;
  const auto& keyframes = odometry.keyframes;
  WheelSigns signs;
  for (std::size_t k = 2; k < keyframes.size(); ++k)
    if (keyframes[k].wheels && is_lost(keyframes[k - 1], keyframes[k]))
      add_span(signs.spans, keyframes[k - 1].t_ns, keyframes[k].t_ns);
  signs.spans = united(std::move(signs.spans), wrong_turns(odometry, wheels));
  const auto ground = ground_factor(odometry, camera_height_m);
  signs.scale = ground && std::abs(std::log(*ground)) > kScaleOff;
  return signs;
}

}  // namespace roadbook
