#include "workflows/report/map_quality.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

MapQuality measure_quality(const Map& map) {
  MapQuality quality;
  quality.observations_of_keyframe.assign(map.keyframes.size(), 0);
  quality.views_of_landmark.assign(map.landmarks.size(), 0);
  for (const Observation& seen : map.observations) {
    const auto keyframe = static_cast<std::size_t>(seen.keyframe);
    const auto landmark = static_cast<std::size_t>(seen.landmark);
    ++quality.observations_of_keyframe[keyframe];
    ++quality.views_of_landmark[landmark];
    const Session& session =
        map.sessions[static_cast<std::size_t>(map.keyframes[keyframe].session)];
    const MountedCamera& camera = session.rig.cameras[static_cast<std::size_t>(seen.camera)];
    const Eigen::Vector3d p_camera =
        (map.T_map_vehicle(seen.keyframe) * camera.T_vehicle_camera).inverse() *
        map.p_map(map.landmarks[landmark]);
    if (const auto pixel = camera.camera.project(p_camera))
      quality.residuals_px.push_back(
          static_cast<float>((*pixel - seen.pixel.cast<double>()).norm()));
    else
      ++quality.behind_camera;
  }
  return quality;
}

double sample_quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  const auto at = static_cast<std::size_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
  return values[at];
}

std::vector<Eigen::Vector2d> driven_positions(const Map& map) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    points.push_back(map.T_map_vehicle(static_cast<int>(i)).translation().head<2>());
  return points;
}

double driven_m(const Map& map) {
  double sum = 0.0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i)
    if (i + 1 == map.keyframes.size() || map.keyframes[i + 1].session != map.keyframes[i].session)
      sum += map.keyframes[i].travelled_m;
  return sum;
}

}  // namespace roadbook
