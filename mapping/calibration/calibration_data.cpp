#include "mapping/calibration/calibration_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/cell_grid.hpp"
#include "base/index.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kMarginNs = 500'000'000;  // of readings around a motion
constexpr std::int64_t kLeastNs = 100'000'000;   // so that its delay is observable

std::vector<CalibrationPose> poses_of(const Map& map,
                                      const std::vector<CalibrationSession>& sessions,
                                      double stretch_m) {
  std::vector<CalibrationPose> poses;
  std::vector<std::uint8_t> piece_seen;
  int stretch = -1;
  double begin_m = 0.0;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    CalibrationPose pose;
    pose.T_map_vehicle = map.T_map_vehicle(static_cast<int>(k));
    pose.t_ns = keyframe.t_ns;
    pose.joined = k > 0 && !keyframe.after_gap && map.keyframes[k - 1].session == keyframe.session;
    piece_seen.resize(std::max(piece_seen.size(), at(keyframe.piece) + 1), 0);
    pose.piece = keyframe.piece;
    const bool used = sessions[at(keyframe.session)].used;
    pose.fixed = !used || piece_seen[at(keyframe.piece)] == 0;
    if (used) piece_seen[at(keyframe.piece)] = 1;
    if (!pose.joined || keyframe.travelled_m - begin_m > stretch_m) {
      ++stretch;
      begin_m = keyframe.travelled_m;
    }
    pose.stretch = stretch;
    poses.push_back(pose);
  }
  set_twists(poses);
  return poses;
}

// Views of each landmark, at most `most`, spread evenly.
std::vector<std::vector<BundleObservation>> views_of(
    const Map& map, const std::vector<CalibrationSession>& sessions, int most) {
  std::vector<std::vector<BundleObservation>> views(map.landmarks.size());
  for (const Observation& seen : map.observations)
    if (sessions[at(map.keyframes[at(seen.keyframe)].session)].used)
      views[at(seen.landmark)].push_back({seen.keyframe, 0, seen.camera, seen.pixel.cast<double>(),
                                          static_cast<double>(seen.sigma_px)});
  for (auto& of_landmark : views) {
    const std::size_t count = of_landmark.size();
    const std::size_t kept = std::min(count, at(most));
    for (std::size_t i = 0; i < kept; ++i) of_landmark[i] = of_landmark[i * count / kept];
    of_landmark.resize(kept);
  }
  return views;
}

// Landmarks with many views first; accepts those that at least half of their images still need.
std::vector<std::size_t> chosen_landmarks(const std::vector<std::vector<BundleObservation>>& views,
                                          std::size_t poses,
                                          std::size_t cameras,
                                          int per_image) {
  std::vector<std::size_t> order;
  for (std::size_t l = 0; l < views.size(); ++l)
    if (views[l].size() >= 3) order.push_back(l);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return views[a].size() > views[b].size(); });
  std::vector<int> taken(poses * cameras, 0);
  const auto image_of = [&](const BundleObservation& v) -> int& {
    return taken[at(v.pose) * cameras + at(v.camera)];
  };
  std::vector<std::size_t> chosen;
  for (const std::size_t l : order) {
    const auto wanting = std::count_if(views[l].begin(), views[l].end(),
                                       [&](const auto& v) { return image_of(v) < per_image; });
    if (2 * static_cast<std::size_t>(wanting) < views[l].size()) continue;
    for (const BundleObservation& v : views[l]) ++image_of(v);
    chosen.push_back(l);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// The nearest pose of a piece from which a ground point lies near the rear axle; -1: none.
int pose_above(const CellGrid<int>& grid,
               const CalibrationData& data,
               const Eigen::Vector3d& p,
               int piece) {
  constexpr double kAheadM = 1.5;
  constexpr double kBesideM = 1.6;
  int nearest = -1;
  double best = std::numeric_limits<double>::max();
  grid.visit_near(p.head<2>(), [&](int k) {
    if (data.poses[at(k)].piece != piece) return;
    const Eigen::Vector3d q = data.poses[at(k)].T_map_vehicle.inverse() * p;
    if (std::abs(q.x()) > kAheadM || std::abs(q.y()) > kBesideM || std::abs(q.z()) > 0.3) return;
    const double distance = q.head<2>().norm();
    if (distance >= best) return;
    best = distance;
    nearest = k;
  });
  return nearest;
}

void add_motions(const Map& map,
                 const std::vector<CalibrationSession>& sessions,
                 CalibrationData& data) {
  for (std::size_t k = 1; k < data.poses.size(); ++k) {
    const CalibrationSession& of = sessions[at(map.keyframes[k].session)];
    if (!of.used || !data.poses[k].joined || !of.model || of.readings.empty()) continue;
    CalibrationMotion motion;
    motion.from = static_cast<int>(k) - 1;
    motion.to = static_cast<int>(k);
    motion.model = *of.model;
    const auto before = [](const WheelReading& r, std::int64_t t) { return r.t_ns < t; };
    const auto first = std::lower_bound(of.readings.begin(), of.readings.end(),
                                        data.poses[k - 1].t_ns - kMarginNs, before);
    const auto last =
        std::lower_bound(first, of.readings.end(), data.poses[k].t_ns + kMarginNs, before);
    motion.readings.assign(first, last);
    if (WheelOdometry(motion.model, motion.readings)
            .between(data.poses[k - 1].t_ns - kLeastNs, data.poses[k].t_ns + kLeastNs))
      data.motions.push_back(std::move(motion));
  }
}

// The map was built with one model: the first session that is used stands for all.
void take_off_known_exposures(const Map& map,
                              const std::vector<CalibrationSession>& sessions,
                              Rig& rig) {
  for (std::size_t s = 0; s < sessions.size(); ++s) {
    const auto& known = map.sessions[s].rig.cameras;
    if (!sessions[s].used || known.size() != rig.cameras.size()) continue;
    for (std::size_t c = 0; c < known.size(); ++c)
      rig.cameras[c].exposed_after_s -= known[c].exposed_after_s;
    return;
  }
}

}  // namespace

void set_twists(std::vector<CalibrationPose>& poses) {
  const auto velocity = [&](std::size_t k, std::size_t other, double& seconds) -> Vector6d {
    seconds = 1e-9 * static_cast<double>(poses[other].t_ns - poses[k].t_ns);
    return se3_log(poses[k].T_map_vehicle.inverse() * poses[other].T_map_vehicle) / seconds;
  };
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const bool has_before = poses[k].joined;
    const bool has_after = k + 1 < poses.size() && poses[k + 1].joined;
    double back = 0.0;
    double ahead = 0.0;
    Vector6d& twist = poses[k].twist;
    twist.setZero();
    if (has_before) twist = velocity(k, k - 1, back);
    if (has_after) {
      const Vector6d next = velocity(k, k + 1, ahead);
      twist = has_before ? Vector6d((ahead * twist - back * next) / (ahead - back)) : next;
    }
  }
}

CalibrationData calibration_data(const Map& map,
                                 const Rig& rig,
                                 const std::vector<CalibrationSession>& sessions,
                                 const CalibrationDataOptions& options) {
  constexpr double kCellM = 2.5;
  CalibrationData data;
  data.rig = rig;
  take_off_known_exposures(map, sessions, data.rig);
  data.poses = poses_of(map, sessions, options.stretch_m);
  const std::size_t cameras = rig.cameras.size();
  const std::size_t images = std::max<std::size_t>(1, data.poses.size() * cameras);
  const int per_image =
      std::min(options.per_image, std::max(6, static_cast<int>(options.most_views / images)));
  auto views = views_of(map, sessions, options.most_views_of_point);
  CellGrid<int> grid(kCellM);
  for (std::size_t k = 0; k < data.poses.size(); ++k)
    grid.insert(data.poses[k].T_map_vehicle.translation().head<2>(), static_cast<int>(k));
  for (const std::size_t l : chosen_landmarks(views, data.poses.size(), cameras, per_image)) {
    const int point = static_cast<int>(data.points.size());
    data.points.push_back(map.p_map(map.landmarks[l]));
    for (BundleObservation& view : views[l]) {
      view.point = point;
      data.views.push_back(view);
    }
    if (!map.landmarks[l].ground) continue;
    const int above =
        pose_above(grid, data, data.points.back(), data.poses[at(views[l].front().pose)].piece);
    if (above >= 0) data.grounds.push_back({above, point});
  }
  add_motions(map, sessions, data);
  return data;
}

}  // namespace roadbook
