#include "mapping/cameras/camera_figures.hpp"

#include <algorithm>

#include "mapping/cameras/principal_point.hpp"
#include "vo/track_drive.hpp"

namespace roadbook {
namespace {

// Sums over one camera's observations.
struct CameraSums {
  std::size_t fitting = 0;
  std::size_t last_corner = 0;  // counted already, plus 1
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  double radial = 0.0;
  double tangential = 0.0;
};

void add_view(const BundleStage& stage,
              const BundleObservation& view,
              CameraSums& sums,
              CameraFigures& figures) {
  const MountedCamera& mounted = stage.problem.cameras[static_cast<std::size_t>(view.camera)];
  const Eigen::Isometry3d T_map_camera =
      stage.problem.poses[static_cast<std::size_t>(view.pose)].T_map_vehicle *
      mounted.T_vehicle_camera;
  const auto point = static_cast<std::size_t>(view.point);
  const auto predicted =
      mounted.camera.project(T_map_camera.inverse() * stage.problem.points[point].p_map);
  if (!predicted) return;
  ++sums.fitting;
  // Observations are in the order of points, and these in that of corners.
  const int of_point = stage.problem.points[point].corner;
  const std::size_t corner = of_point < 0 ? point : static_cast<std::size_t>(of_point);
  if (sums.last_corner != corner + 1) ++figures.landmarks;
  sums.last_corner = corner + 1;
  const Eigen::Vector2d residual = kFullPerHalfPixel * (view.pixel - *predicted);
  sums.residual += residual;
  const Eigen::Vector2d outwards = (view.pixel - principal_point(mounted.camera)).normalized();
  if (!outwards.allFinite()) return;
  sums.radial += residual.dot(outwards);
  sums.tangential += outwards.x() * residual.y() - outwards.y() * residual.x();
}

void finish(const CameraSums& sums, CameraFigures& figures) {
  const auto n = static_cast<double>(sums.fitting);
  if (figures.corners > 0) figures.fit_share = n / static_cast<double>(figures.corners);
  if (figures.keyframes > 0) figures.views = n / static_cast<double>(figures.keyframes);
  if (sums.fitting > 0)
    figures.residual = MeanResidual{sums.radial / n, sums.tangential / n, sums.residual.x() / n,
                                    sums.residual.y() / n};
}

// Share of a camera's images at whose time another camera has one.
std::optional<double> paired_share(const Drive& drive, std::size_t camera) {
  const std::size_t cameras = drive.rig().cameras.size();
  if (cameras < 2) return std::nullopt;
  std::size_t images = 0;
  std::size_t paired = 0;
  for (std::size_t f = 0; f < drive.frame_count(); ++f) {
    if (!drive.has_image(f, camera)) continue;
    ++images;
    bool has_other = false;
    for (std::size_t c = 0; c < cameras; ++c)
      has_other = has_other || (c != camera && drive.has_image(f, c));
    paired += has_other ? 1 : 0;
  }
  if (images == 0) return std::nullopt;
  return static_cast<double>(paired) / static_cast<double>(images);
}

// Median time from the nearest image of another camera to each unpaired image.
std::optional<double> lateness_s(const Drive& drive, std::size_t camera) {
  std::vector<std::int64_t> others;
  std::vector<std::int64_t> alone;
  for (std::size_t f = 0; f < drive.frame_count(); ++f) {
    bool has_other = false;
    for (std::size_t c = 0; c < drive.rig().cameras.size(); ++c)
      has_other = has_other || (c != camera && drive.has_image(f, c));
    if (has_other) others.push_back(drive.frame_stamp_ns(f));
    if (!has_other && drive.has_image(f, camera)) alone.push_back(drive.frame_stamp_ns(f));
  }
  if (others.empty() || alone.empty()) return std::nullopt;
  std::vector<std::int64_t> late;
  for (const std::int64_t t : alone) {
    const auto after = std::lower_bound(others.begin(), others.end(), t);
    const std::int64_t to = after == others.end() ? others.back() : *after;
    const std::int64_t from = after == others.begin() ? others.front() : *(after - 1);
    late.push_back(t - from <= to - t || to < t ? t - from : t - to);
  }
  std::nth_element(late.begin(), late.begin() + static_cast<std::ptrdiff_t>(late.size() / 2),
                   late.end());
  return static_cast<double>(late[late.size() / 2]) * 1e-9;
}

}  // namespace

std::vector<CameraFigures> camera_figures(const MappingInput& input,
                                          const std::vector<Drive>& drives,
                                          const BundleStage& stage,
                                          const BundleResult& result) {
  std::vector<CameraFigures> figures;
  for (const Drive& drive : drives)
    for (std::size_t c = 0; c < drive.rig().cameras.size(); ++c) {
      CameraFigures camera;
      camera.session = drive.name();
      camera.camera = drive.rig().cameras[c].name;
      camera.paired_share = paired_share(drive, c);
      if (camera.paired_share && *camera.paired_share < 0.5) camera.late_s = lateness_s(drive, c);
      figures.push_back(std::move(camera));
    }
  for (std::size_t k = 0; k < input.session.size(); ++k) {
    const auto session = static_cast<std::size_t>(input.session[k]);
    const std::size_t frame = input.odometry.keyframes[k].frame;
    for (std::size_t c = 0; c < drives[session].rig().cameras.size(); ++c)
      if (drives[session].has_image(frame, c))
        ++figures[static_cast<std::size_t>(stage.camera_base[session]) + c].keyframes;
  }
  std::vector<CameraSums> sums(figures.size());
  for (std::size_t i = 0; i < stage.problem.observations.size(); ++i) {
    const BundleObservation& view = stage.problem.observations[i];
    const auto camera = static_cast<std::size_t>(view.camera);
    ++figures[camera].corners;
    if (result.inlier[i]) add_view(stage, view, sums[camera], figures[camera]);
  }
  for (std::size_t c = 0; c < figures.size(); ++c) finish(sums[c], figures[c]);
  return figures;
}

}  // namespace roadbook
