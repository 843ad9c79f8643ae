#include "diagnosis/detector/person_detections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnosis/streams/pose_motion.hpp"

namespace roadbook {
namespace {

Eigen::Matrix2d rotation(double heading) {
  Eigen::Matrix2d R;
  R << std::cos(heading), -std::sin(heading), std::sin(heading), std::cos(heading);
  return R;
}

Eigen::Matrix2d stated_covariance(const Detection& d) {
  constexpr double kLeast = 1e-4;  // [m^2] least variance: 1 cm
  return covariance_of(d) + kLeast * Eigen::Matrix2d::Identity();
}

// Position (vehicle frame) of the nearest camera that faces `place`; of the nearest camera if none
// faces it; of the vehicle's origin without cameras.
Eigen::Vector2d facing(const Rig& rig, const Eigen::Vector2d& place) {
  Eigen::Vector2d best(0.0, 0.0);
  double least = 1e300;
  for (const MountedCamera& camera : rig.cameras) {
    const Eigen::Vector2d eye = camera.T_vehicle_camera.translation().head<2>();
    const Eigen::Vector2d axis = camera.T_vehicle_camera.linear().col(2).head<2>();
    const double cost = (place - eye).norm() + ((place - eye).dot(axis) < 0.0 ? 1e6 : 0.0);
    if (cost >= least) continue;
    least = cost;
    best = eye;
  }
  return best;
}

// Detector frames of both tables, each time once, in order.
std::vector<Look> instants(const std::vector<Detection>& detections,
                           const std::vector<Look>& looks) {
  std::vector<Look> all = looks;
  for (const Detection& d : detections) all.push_back({d.t_ns, {}});
  std::stable_sort(all.begin(), all.end(),
                   [](const Look& a, const Look& b) { return a.t_ns < b.t_ns; });
  all.erase(std::unique(all.begin(), all.end(),
                        [](const Look& a, const Look& b) { return a.t_ns == b.t_ns; }),
            all.end());
  return all;
}

}  // namespace

Eigen::Vector2d SightingReadings::eye_at(std::size_t look, const Eigen::Vector2d& mount) const {
  const DetectorFrame& at = looks[look];
  return Eigen::Vector2d(at.x, at.y) + rotation(at.heading) * mount;
}

bool SightingReadings::in_sight(std::size_t look, const Eigen::Vector2d& place) const {
  constexpr double kMargin = 0.5;  // [m]
  const DetectorFrame& at = looks[look];
  const Eigen::Vector2d d =
      rotation(at.heading).transpose() * (place - Eigen::Vector2d(at.x, at.y));
  for (const Eigen::Vector2d& mount : mounts)
    if ((d - mount).norm() < nearest_m + kMargin) return false;
  if (at.reach_m.empty()) return true;
  const double turn = std::atan2(d.y(), d.x()) / (2.0 * std::numbers::pi);
  const auto n = at.reach_m.size();
  const auto k = static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(n)) % n;
  // Visibility is uncertain at the edge of the visible range.
  const double reach =
      std::min({at.reach_m[k], at.reach_m[(k + 1) % n], at.reach_m[(k + n - 1) % n]});
  return d.norm() + kMargin < reach;
}

namespace {

// Lists the camera positions and the smallest range of a detection.
void list_mounts(SightingReadings& r) {
  r.nearest_m = 1e9;
  for (const Sighting& s : r.sightings) {
    const bool known = std::any_of(r.mounts.begin(), r.mounts.end(), [&](const auto& mount) {
      return (mount - s.mount).norm() < 0.01;
    });
    if (!known) r.mounts.push_back(s.mount);
    r.nearest_m = std::min(r.nearest_m, (s.foot - s.eye).norm());
  }
}

}  // namespace

SightingReadings sighting_readings(const std::vector<Detection>& detections,
                                   const std::vector<Look>& looks,
                                   const Rig& rig,
                                   const std::vector<PoseSample>& poses,
                                   std::int64_t origin_ns) {
  SightingReadings r;
  r.frames_known = !looks.empty();
  PoseSmoother smoother(poses, 0.35);
  std::vector<Detection> rows = detections;
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Detection& a, const Detection& b) { return a.t_ns < b.t_ns; });
  auto row = rows.begin();
  for (const Look& look : instants(rows, looks)) {
    const double t = 1e-9 * static_cast<double>(look.t_ns - origin_ns);
    const auto pose = smoother.at(t);
    while (row != rows.end() && row->t_ns < look.t_ns) ++row;
    if (!pose) continue;
    DetectorFrame at{t, pose->x, pose->y, pose->heading, pose->speed, pose->yaw_rate, {}};
    for (const std::uint8_t reach : look.reach_dm) at.reach_m.push_back(0.1 * reach);
    r.looks.push_back(std::move(at));
    const Eigen::Matrix2d R = rotation(pose->heading);
    const Eigen::Vector2d origin(pose->x, pose->y);
    for (; row != rows.end() && row->t_ns == look.t_ns; ++row) {
      const Eigen::Vector2d foot(row->x_m, row->y_m);
      const Eigen::Vector2d eye =
          row->eye_m ? Eigen::Vector2d((*row->eye_m)[0], (*row->eye_m)[1]) : facing(rig, foot);
      if ((foot - eye).norm() < 0.3) continue;  // too close for a line of sight
      r.sightings.push_back({t, r.looks.size() - 1, eye, origin + R * eye, origin + R * foot,
                             R * stated_covariance(*row) * R.transpose()});
    }
  }
  list_mounts(r);
  return r;
}

SightingReadings sighting_readings(const Drive& drive, const std::vector<PoseSample>& poses) {
  const auto folder = detector_folder(drive.folder());
  const auto truth = drive.truth();
  std::error_code ignored;
  if (!std::filesystem::exists(folder / "data.csv", ignored) || truth.empty()) return {};
  const auto looks_file = folder / "looks.csv";
  auto detections = read_detections(folder / "data.csv");
  auto looks =
      std::filesystem::exists(looks_file, ignored) ? read_looks(looks_file) : std::vector<Look>{};
  const std::int64_t offset_ns = image_offset_ns(drive.rig());
  for (Detection& detection : detections) detection.t_ns += offset_ns;
  for (Look& look : looks) look.t_ns += offset_ns;
  return sighting_readings(detections, looks, drive.rig(), poses, truth.front().t_ns);
}

}  // namespace roadbook
