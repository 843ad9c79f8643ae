#include "diagnosis/views/view_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

#include "base/error.hpp"
#include "base/index.hpp"
#include "diagnosis/views/view_moments.hpp"
#include "diagnosis/views/view_tracks.hpp"
#include "vo/planar_motion.hpp"

namespace roadbook {
namespace {

constexpr int kCells = 5;  // cells across and down an image, for an even choice of views

// Accepts a landmark if at least half of its images need more views in that cell of the image.
class Quota {
 public:
  Quota(const std::vector<MountedCamera>& cameras, std::size_t poses, int per_image)
      : cameras_(cameras),
        per_image_(per_image),
        per_cell_(std::max(1, 3 * per_image / (kCells * kCells))),
        total_(poses * cameras.size(), 0),
        cell_(poses * cameras.size() * kCells * kCells, 0) {}

  bool take(const std::vector<Sight>& sights) {
    std::size_t wanted = 0;
    for (const Sight& s : sights)
      wanted += total_[image(s)] < per_image_ && cell_[cell(s)] < per_cell_ ? 1 : 0;
    if (2 * wanted < sights.size()) return false;
    for (const Sight& s : sights) {
      ++total_[image(s)];
      ++cell_[cell(s)];
    }
    return true;
  }

 private:
  [[nodiscard]] std::size_t image(const Sight& s) const {
    return at(s.pose) * cameras_.size() + at(s.seen->camera);
  }
  [[nodiscard]] std::size_t cell(const Sight& s) const {
    const Camera& camera = cameras_[at(s.seen->camera)].camera;
    const auto part = [](double x, int size) {
      return std::clamp(static_cast<int>(kCells * x / size), 0, kCells - 1);
    };
    return (image(s) * kCells + at(part(s.seen->pixel.y(), camera.height))) * kCells +
           at(part(s.seen->pixel.x(), camera.width));
  }
  const std::vector<MountedCamera>& cameras_;
  int per_image_;
  int per_cell_;
  std::vector<int> total_;
  std::vector<int> cell_;
};

// The pose nearest to a point, if the point lies near the wheels there.
int ground_pose(const std::vector<Sight>& sights,
                const std::vector<BundlePose>& poses,
                const Eigen::Vector3d& p_map,
                const ViewDataOptions& options) {
  const int first = std::max(0, sights.front().pose - options.reach_keyframes);
  const int last =
      std::min(static_cast<int>(poses.size()) - 1, sights.front().pose + options.reach_keyframes);
  int best = -1;
  double least = std::numeric_limits<double>::max();
  for (int k = first; k <= last; ++k) {
    const Eigen::Vector3d p = poses[at(k)].T_map_vehicle.inverse() * p_map;
    if (std::abs(p.x()) > options.ground_ahead_m || std::abs(p.y()) > options.ground_beside_m)
      continue;
    if (const double d = p.head<2>().squaredNorm(); d < least) {
      least = d;
      best = k;
    }
  }
  return best;
}

void add_poses(const Map& map, int session, ViewData& data, std::vector<int>& pose_of) {
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].session != session) continue;
    pose_of[k] = static_cast<int>(data.keyframe.size());
    data.keyframe.push_back(static_cast<int>(k));
    data.bundle.poses.push_back({map.T_map_vehicle(static_cast<int>(k)), false});
  }
}

void add_points(const Map& map,
                int session,
                const std::vector<int>& pose_of,
                const ViewDataOptions& options,
                ViewData& data) {
  const std::vector<ViewTrack> tracks =
      view_tracks(map, session, pose_of, data.bundle.poses, options.reach_keyframes);
  std::vector<std::size_t> order(tracks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  // Consistent tracks first; among these ground points, which are rare; then long tracks.
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto worth = [&](const ViewTrack& t) {
      return std::tuple(-t.tenths_off, map.landmarks[at(t.landmark)].ground, t.sights.size());
    };
    return worth(tracks[a]) > worth(tracks[b]);
  });
  Quota quota(data.bundle.cameras, data.bundle.poses.size(), options.per_image);
  std::vector<std::size_t> chosen;
  for (const std::size_t t : order)
    if (quota.take(tracks[t].sights)) chosen.push_back(t);
  std::sort(chosen.begin(), chosen.end());
  for (const std::size_t t : chosen) {
    const ViewTrack& track = tracks[t];
    BundlePoint point;
    point.p_map = track.p_map;
    if (map.landmarks[at(track.landmark)].ground)
      point.ground_pose = ground_pose(track.sights, data.bundle.poses, point.p_map, options);
    point.ground = point.ground_pose >= 0;
    const int p = static_cast<int>(data.bundle.points.size());
    for (const Sight& s : track.sights)
      data.bundle.observations.push_back(
          {s.pose, p, s.seen->camera, s.seen->pixel.cast<double>(), 1.0});
    data.bundle.points.push_back(point);
    data.landmark.push_back(track.landmark);
  }
}

void add_motions(const Map& map, const Drive& drive, ViewData& data) {
  if (!drive.wheel_model()) return;
  const WheelOdometry odometry(data.wheels, drive.wheel_readings());
  for (std::size_t k = 1; k < data.keyframe.size(); ++k) {
    if (map.keyframes[at(data.keyframe[k])].after_gap) continue;
    const auto motion = odometry.between(data.moments[k - 1].t_ns, data.moments[k].t_ns);
    if (!motion) continue;
    data.bundle.motions.push_back({static_cast<int>(k) - 1, static_cast<int>(k),
                                   planar_transform(*motion), planar_information(*motion), -1});
  }
  data.has_wheels = !data.bundle.motions.empty();
}

}  // namespace

void ViewDataOptions::check() const {
  if (per_image < 1) throw InvalidOption("per_image", std::to_string(per_image), "at least 1");
  if (reach_keyframes < 1)
    throw InvalidOption("reach_keyframes", std::to_string(reach_keyframes), "at least 1");
}

ViewData view_data(const Map& map,
                   int session,
                   const Drive& drive,
                   const ViewDataOptions& options) {
  options.check();
  ViewData data;
  // The calibration that the drive states. The map may have been built with a corrected one.
  data.bundle.cameras = map.sessions[at(session)].rig.cameras;
  if (drive.rig().cameras.size() == data.bundle.cameras.size())
    data.bundle.cameras = drive.rig().cameras;
  // The map's corners lie where they would have been at the stamps, by what it knew of exposures.
  for (std::size_t c = 0; c < data.bundle.cameras.size(); ++c) {
    MountedCamera& camera = data.bundle.cameras[c];
    const MountedCamera& known = map.sessions[at(session)].rig.cameras[c];
    camera.exposed_after_s -= known.exposed_after_s;
    camera.rolling_shutter_s -= known.rolling_shutter_s;
  }
  if (drive.wheel_model()) data.wheels = *drive.wheel_model();
  std::vector<int> pose_of(map.keyframes.size(), -1);
  add_poses(map, session, data, pose_of);
  std::vector<std::int64_t> stamps;
  for (const int k : data.keyframe) stamps.push_back(map.keyframes[at(k)].t_ns);
  data.moments = view_moments(stamps, data.bundle.poses, drive);
  add_points(map, session, pose_of, options, data);
  add_motions(map, drive, data);
  return data;
}

}  // namespace roadbook
