#include "mapping/pipeline/landmark_covariance.hpp"

#include <algorithm>
#include <span>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "mapping/inverse_information.hpp"

namespace roadbook {
namespace {

using Views = std::span<const KeyPointId>;

Eigen::Matrix3d covariance_given_poses(const MappingInput& input,
                                       const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                       Views views,
                                       const Eigen::Vector3d& p_map,
                                       double sigma_px) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const KeyPointId& view : views) {
    const MountedCamera& mounted = input.rig_of(view.keyframe).cameras[at(view.camera)];
    const Eigen::Isometry3d T_camera_map =
        (T_map_vehicle[at(view.keyframe)] * mounted.T_vehicle_camera).inverse();
    Eigen::Matrix<double, 2, 3> J;
    if (!mounted.camera.project(T_camera_map * p_map, &J) || !J.allFinite()) continue;
    const Eigen::Matrix<double, 2, 3> whitened = J * T_camera_map.linear() / sigma_px;
    information.noalias() += whitened.transpose() * whitened;
  }
  return covariance_of_information(information);
}

// Squared Mahalanobis distance of the positions from the early and from the late views; negative
// where a half alone gives no position.
double halves_apart(const MappingInput& input,
                    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                    const JoinedTrack& track,
                    double sigma_px,
                    const TriangulationOptions& options) {
  const Views views(track.views);
  const std::size_t middle = views.size() / 2;
  const Views early = views.first(middle);
  const Views late = views.subspan(middle);
  const auto a = triangulate_key_points(input, T_map_vehicle, early, options);
  const auto b = triangulate_key_points(input, T_map_vehicle, late, options);
  if (!a || !b) return -1.0;
  const Eigen::Matrix3d sum = covariance_given_poses(input, T_map_vehicle, early, *a, sigma_px) +
                              covariance_given_poses(input, T_map_vehicle, late, *b, sigma_px);
  if (!is_known(sum)) return -1.0;
  return (*a - *b).dot(sum.inverse() * (*a - *b));
}

std::vector<double> distances(const MappingInput& input,
                              const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                              const std::vector<JoinedTrack>& tracks,
                              double sigma_px,
                              const TriangulationOptions& options) {
  constexpr std::size_t kFewestViews = 6;
  constexpr std::size_t kMost = 2000;
  std::vector<std::size_t> long_ones;
  for (std::size_t t = 0; t < tracks.size(); ++t)
    if (tracks[t].p_map && tracks[t].views.size() >= kFewestViews) long_ones.push_back(t);
  const std::size_t step = long_ones.size() / kMost + 1;
  std::vector<double> apart((long_ones.size() + step - 1) / step);
  parallel_for_small(apart.size(), options.num_threads, [&](std::size_t i) {
    apart[i] = halves_apart(input, T_map_vehicle, tracks[long_ones[i * step]], sigma_px, options);
  });
  std::erase_if(apart, [](double d) { return d < 0.0; });
  return apart;
}

}  // namespace

LandmarkCovariances landmark_covariances(const MappingInput& input,
                                         const std::vector<Eigen::Isometry3d>& T_map_vehicle,
                                         const std::vector<JoinedTrack>& tracks,
                                         double sigma_px,
                                         const TriangulationOptions& options) {
  constexpr std::size_t kFewest = 20;
  constexpr double kShare = 0.95;
  constexpr double kChi2 = 7.815;  // its quantile, 3 degrees of freedom
  LandmarkCovariances result;
  auto apart = distances(input, T_map_vehicle, tracks, sigma_px, options);
  result.compared = static_cast<int>(apart.size());
  constexpr double kLeast = 0.05;  // exact pixels would promise exact landmarks
  if (apart.size() >= kFewest) {
    const auto tail =
        apart.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(apart.size() - 1));
    std::nth_element(apart.begin(), tail, apart.end());
    result.factor = std::max(kLeast, *tail / kChi2);
  }
  result.of_track.assign(tracks.size(), unknown_covariance<Eigen::Matrix3d>());
  parallel_for_small(tracks.size(), options.num_threads, [&](std::size_t t) {
    if (tracks[t].p_map)
      result.of_track[t] =
          result.factor *
          covariance_given_poses(input, T_map_vehicle, tracks[t].views, *tracks[t].p_map, sigma_px);
  });
  return result;
}

}  // namespace roadbook
