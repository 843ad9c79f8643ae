#include "mapping/loops/loop_scale.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/index.hpp"
#include "base/median.hpp"

namespace roadbook {
namespace {

// Place of the corner in the keyframe's vehicle frame, in the odometry's unit there.
std::optional<Eigen::Vector3d> place_of(const VoResult& odometry,
                                        int keyframe,
                                        int camera,
                                        int feature) {
  const VoKeyframe& k = odometry.keyframes[at(keyframe)];
  const int track = k.tracks[at(camera)][at(feature)];
  if (track < 0 || !odometry.tracks[at(track)].p_odom) return std::nullopt;
  return k.T_odom_vehicle.inverse() * *odometry.tracks[at(track)].p_odom;
}

}  // namespace

std::optional<LoopScale> scale_of_loop(const Rig& rig,
                                       const VoResult& odometry,
                                       const LoopEdge& edge,
                                       const std::vector<FeatureMatch>& matches) {
  constexpr std::size_t kFewest = 6;
  constexpr double kLeastSigma = 0.02;     // corners of one view share the errors of its poses
  constexpr double kIndependent = 0.25;    // share of the corners that count as independent
  constexpr double kSigmaPerMad = 1.4826;  // of a normal distribution
  const Eigen::Isometry3d T_to_from = edge.T_from_to.inverse();
  std::vector<double> logs;
  for (const FeatureMatch& m : matches) {
    const auto p_from = place_of(odometry, edge.from, m.from_camera, m.from_feature);
    const auto p_to = place_of(odometry, edge.to, m.to_camera, m.to_feature);
    if (!p_from || !p_to) continue;
    const Eigen::Vector3d camera = rig.cameras[at(m.to_camera)].T_vehicle_camera.translation();
    const double by_earlier = (T_to_from * *p_from - camera).norm();
    const double by_later = (*p_to - camera).norm();
    if (by_earlier > 0.0 && by_later > 0.0) logs.push_back(std::log(by_earlier / by_later));
  }
  if (logs.size() < kFewest) return std::nullopt;
  LoopScale scale;
  scale.log_scale = median(logs);
  for (double& log : logs) log = std::abs(log - scale.log_scale);
  const double spread = kSigmaPerMad * median(logs);
  scale.sigma =
      std::hypot(kLeastSigma, spread / std::sqrt(kIndependent * static_cast<double>(logs.size())));
  return scale;
}

}  // namespace roadbook
