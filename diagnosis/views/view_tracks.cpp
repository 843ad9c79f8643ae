#include "diagnosis/views/view_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/index.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

// A gap of more keyframes than this starts a new pass.
constexpr int kPassGapKeyframes = 20;
constexpr std::size_t kFewestOfPass = 4;
constexpr double kLeastPassParallax = 0.05;  // [rad]
constexpr double kEdge = 0.15;               // [rad]
constexpr double kFarMedians = 4.0;          // [medians]; one view in 60,000 with normal noise

using Cameras = std::vector<MountedCamera>;
using Poses = std::vector<BundlePose>;

// The views of each pass within `reach` keyframes of the keyframe nearest to the landmark.
std::vector<std::vector<Sight>> passes_of(const std::vector<Sight>& sights,
                                          const Poses& poses,
                                          const Eigen::Vector3d& p_map,
                                          int reach) {
  std::vector<std::vector<Sight>> passes;
  for (std::size_t begin = 0, end = 0; begin < sights.size(); begin = end) {
    int nearest = sights[begin].pose;
    double least = std::numeric_limits<double>::max();
    for (end = begin;
         end < sights.size() &&
         (end == begin || sights[end].pose - sights[end - 1].pose <= kPassGapKeyframes);
         ++end) {
      const double d =
          (poses[at(sights[end].pose)].T_map_vehicle.translation() - p_map).squaredNorm();
      if (d >= least) continue;
      least = d;
      nearest = sights[end].pose;
    }
    std::vector<Sight> near;
    for (std::size_t i = begin; i < end; ++i)
      if (std::abs(sights[i].pose - nearest) <= reach) near.push_back(sights[i]);
    passes.push_back(std::move(near));
  }
  return passes;
}

// A view at the edge of the field of view would be lost when an effect moves it outside. The fit
// with fewer views would then seem better.
bool well_inside(const Camera& camera, const Eigen::Vector2d& pixel) {
  const auto bearing = camera.bearing(pixel);
  return bearing &&
         std::acos(std::clamp(bearing->normalized().z(), -1.0, 1.0)) < camera.max_angle_rad - kEdge;
}

// The landmark triangulated from the views of this pass alone.
std::optional<Eigen::Vector3d> seen_place(const std::vector<Sight>& sights,
                                          const Cameras& cameras,
                                          const Poses& poses) {
  std::vector<Ray> rays;
  for (const Sight& s : sights) {
    const MountedCamera& mounted = cameras[at(s.seen->camera)];
    const auto bearing = mounted.camera.bearing(s.seen->pixel.cast<double>());
    if (!bearing) continue;
    const Eigen::Isometry3d T = poses[at(s.pose)].T_map_vehicle * mounted.T_vehicle_camera;
    rays.push_back({T.translation(), T.linear() * *bearing});
  }
  const auto point = triangulate(rays, kLeastPassParallax);
  if (!point) return std::nullopt;
  return point->p_world;
}

// Reprojection errors of a track at the poses and calibration of the map.
std::vector<double> errors_px(const ViewTrack& track, const Cameras& cameras, const Poses& poses) {
  std::vector<double> errors;
  for (const Sight& s : track.sights) {
    const MountedCamera& mounted = cameras[at(s.seen->camera)];
    const auto pixel = mounted.camera.project(
        (poses[at(s.pose)].T_map_vehicle * mounted.T_vehicle_camera).inverse() * track.p_map);
    errors.push_back(pixel ? (*pixel - s.seen->pixel.cast<double>()).norm()
                           : std::numeric_limits<double>::max());
  }
  return errors;
}

void judge_tracks(const Cameras& cameras, const Poses& poses, std::vector<ViewTrack>& tracks) {
  std::vector<std::vector<double>> errors;
  std::vector<std::vector<double>> of_camera(cameras.size());
  for (const ViewTrack& track : tracks) {
    errors.push_back(errors_px(track, cameras, poses));
    for (std::size_t i = 0; i < track.sights.size(); ++i)
      of_camera[at(track.sights[i].seen->camera)].push_back(errors.back()[i]);
  }
  std::vector<double> far_px;
  for (auto& all : of_camera) {
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end());
    far_px.push_back(all.empty() ? 0.0 : kFarMedians * *middle);
  }
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const std::vector<Sight>& sights = tracks[t].sights;
    std::size_t off = 0;
    for (std::size_t i = 0; i < sights.size(); ++i)
      off += errors[t][i] > far_px[at(sights[i].seen->camera)] ? 1 : 0;
    tracks[t].tenths_off = static_cast<int>((10 * off + sights.size() - 1) / sights.size());
  }
}

}  // namespace

std::vector<ViewTrack> view_tracks(const Map& map,
                                   int session,
                                   const std::vector<int>& pose_of,
                                   const std::vector<BundlePose>& poses,
                                   int reach) {
  // The calibration of the map, because the poses of the map belong to it.
  const Cameras& cameras = map.sessions[at(session)].rig.cameras;
  std::vector<std::vector<Sight>> sights(map.landmarks.size());
  for (const Observation& o : map.observations)
    if (const int pose = pose_of[at(o.keyframe)];
        pose >= 0 && well_inside(cameras[at(o.camera)].camera, o.pixel.cast<double>()))
      sights[at(o.landmark)].push_back({pose, &o});
  std::vector<ViewTrack> tracks;
  for (std::size_t l = 0; l < sights.size(); ++l)
    for (auto& pass : passes_of(sights[l], poses, map.p_map(map.landmarks[l]), reach)) {
      if (pass.size() < kFewestOfPass) continue;
      const auto place = seen_place(pass, cameras, poses);
      if (place) tracks.push_back({static_cast<int>(l), std::move(pass), *place, 0});
    }
  judge_tracks(cameras, poses, tracks);
  return tracks;
}

}  // namespace roadbook
