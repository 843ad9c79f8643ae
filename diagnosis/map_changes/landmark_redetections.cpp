#include "diagnosis/map_changes/landmark_redetections.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/cell_grid.hpp"
#include "base/index.hpp"

namespace roadbook {
namespace {

using ViewIndex = std::pair<int, int>;  // keyframe, camera

constexpr std::array kSides{0.05, 0.1, 0.2};  // [rad] bounds between classes of angles
constexpr std::array kRanges{2.0, 4.0, 8.0};  // [m]
constexpr std::size_t kClasses = (kSides.size() + 1) * (kRanges.size() + 1);

std::size_t class_of(double side_rad, double range_m) {
  const auto part = [](const auto& bounds, double x) {
    return static_cast<std::size_t>(std::lower_bound(bounds.begin(), bounds.end(), x) -
                                    bounds.begin());
  };
  return part(kSides, side_rad) * (kRanges.size() + 1) + part(kRanges, range_m);
}

/// An expected view of a landmark by the drive.
struct Trial {
  std::size_t chance = 0;
  int keyframe = 0;
  std::size_t of_class = 0;
  double range_m = 0.0;
  bool seen = false;
};

struct Views {
  std::vector<ViewIndex> then;
  std::vector<ViewIndex> now;  // sorted
};

std::vector<Views> views_of(const Map& map, int session, const std::vector<LandmarkTwin>& twins) {
  std::vector<Views> views(map.landmarks.size());
  for (const Observation& o : map.observations) {
    Views& v = views[at(o.landmark)];
    const bool own = map.keyframes[at(o.keyframe)].session == session;
    (own ? v.now : v.then).emplace_back(o.keyframe, o.camera);
  }
  for (const LandmarkTwin& twin : twins)
    if (twin.again != twin.landmark) views[at(twin.landmark)].now = views[at(twin.again)].now;
  for (Views& v : views) std::sort(v.now.begin(), v.now.end());
  return views;
}

// Returns the most similar keyframe of the drive for each keyframe of other sessions; -1: no
// similar one.
std::vector<int> keyframes_alike(const Map& map, int session, const RedetectionOptions& options) {
  const auto count = static_cast<int>(map.keyframes.size());
  std::vector<Eigen::Isometry3d> poses;
  CellGrid<std::size_t> grid(options.near_m);
  for (int k = 0; k < count; ++k) {
    poses.push_back(map.T_map_vehicle(k));
    if (map.keyframes[at(k)].session == session)
      grid.insert(poses.back().translation().head<2>(), at(k));
  }
  std::vector<int> alike(at(count), -1);
  for (int k = 0; k < count; ++k) {
    if (map.keyframes[at(k)].session == session) continue;
    const Eigen::Isometry3d& T = poses[at(k)];
    double least = 1.0;
    grid.visit_near(T.translation().head<2>(), [&](std::size_t j) {
      const double off = (poses[j].translation() - T.translation()).norm() / options.near_m;
      const double turned =
          std::acos(std::clamp(poses[j].linear().col(0).dot(T.linear().col(0)), -1.0, 1.0)) /
          options.turn_rad;
      if (const double apart = std::max(off, turned); apart < least) {
        least = apart;
        alike[at(k)] = static_cast<int>(j);
      }
    });
  }
  return alike;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Poses of all cameras of all keyframes.
class CameraPoses {
 public:
  explicit CameraPoses(const Map& map) : map_(map), first_(map.keyframes.size() + 1, 0) {
    for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
      const auto& cameras = map.sessions[at(map.keyframes[k].session)].rig.cameras;
      first_[k + 1] = first_[k] + cameras.size();
      const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k));
      for (const MountedCamera& camera : cameras) poses_.push_back(T * camera.T_vehicle_camera);
    }
  }
  [[nodiscard]] bool has(const ViewIndex& v) const {
    return first_[at(v.first)] + at(v.second) < first_[at(v.first) + 1];
  }
  [[nodiscard]] const Eigen::Isometry3d& operator[](const ViewIndex& v) const {
    return poses_[first_[at(v.first)] + at(v.second)];
  }
  [[nodiscard]] const Camera& camera(const ViewIndex& v) const {
    return map_.sessions[at(map_.keyframes[at(v.first)].session)].rig.cameras[at(v.second)].camera;
  }

 private:
  const Map& map_;
  std::vector<std::size_t> first_;
  std::vector<Eigen::Isometry3d> poses_;
};

// Largest angle [rad] between the first line of sight and the others.
double parallax(const std::vector<ViewIndex>& views,
                const Eigen::Vector3d& p,
                const CameraPoses& poses) {
  double widest = 0.0;
  const Eigen::Vector3d first = p - poses[views.front()].translation();
  for (const ViewIndex& v : views)
    widest = std::max(widest, angle_between(first, p - poses[v].translation()));
  return widest;
}

// Adds the expected views of one landmark, each keyframe and camera once.
void add_trials(const Views& views,
                std::size_t chance,
                const Eigen::Vector3d& p,
                const CameraPoses& poses,
                const std::vector<int>& alike,
                const RedetectionOptions& options,
                std::vector<Trial>& trials) {
  std::vector<ViewIndex> tried;
  for (const ViewIndex& then : views.then) {
    const ViewIndex now{alike[at(then.first)], then.second};
    if (now.first < 0 || !poses.has(now) ||
        std::find(tried.begin(), tried.end(), now) != tried.end())
      continue;
    const Eigen::Vector3d p_camera = poses[now].inverse() * p;
    const auto pixel = poses.camera(now).project(p_camera);
    if (!pixel || !poses.camera(now).contains(*pixel, options.margin_px)) continue;
    const double side = angle_between(p - poses[then].translation(), p - poses[now].translation());
    if (side > options.side_rad) continue;
    tried.push_back(now);
    const double range = p_camera.norm();
    trials.push_back({chance, now.first, class_of(side, range), range,
                      std::binary_search(views.now.begin(), views.now.end(), now)});
  }
}

// A keyframe with hardly any redetections may have a wrong pose and is not evidence.
void drop_untrusted(std::size_t keyframes, int trusted, std::vector<Trial>& trials) {
  std::vector<int> seen(keyframes, 0);
  for (const Trial& t : trials) seen[at(t.keyframe)] += t.seen ? 1 : 0;
  std::erase_if(trials, [&](const Trial& t) { return seen[at(t.keyframe)] < trusted; });
}

void count(const std::vector<Trial>& trials, std::vector<LandmarkRedetection>& chances) {
  std::array<double, kClasses> tried{};
  std::array<double, kClasses> seen{};
  for (const Trial& t : trials) {
    tried[t.of_class] += 1.0;
    seen[t.of_class] += t.seen ? 1.0 : 0.0;
  }
  for (const Trial& t : trials) {
    LandmarkRedetection& c = chances[t.chance];
    c.expected += seen[t.of_class] / tried[t.of_class];
    c.sightings += t.seen ? 1 : 0;
    c.range_m = c.range_m == 0.0 ? t.range_m : std::min(c.range_m, t.range_m);
  }
}

constexpr int kFeatures = 5;
using ChanceFeatures = Eigen::Matrix<double, kFeatures, 1>;

ChanceFeatures features_of(const LandmarkRedetection& c) {
  ChanceFeatures f;
  f << 1.0, std::log(c.expected), std::log(std::max(c.range_m, 0.3)), std::log(c.views),
      c.ground ? 1.0 : 0.0;
  return f;
}

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

}  // namespace

std::vector<LandmarkRedetection> landmark_redetections(const Map& map,
                                                       int session,
                                                       const std::vector<LandmarkTwin>& twins,
                                                       const RedetectionOptions& options) {
  const std::vector<Views> views = views_of(map, session, twins);
  const std::vector<int> alike = keyframes_alike(map, session, options);
  const CameraPoses poses(map);
  std::vector<LandmarkRedetection> chances;
  std::vector<Trial> trials;
  for (std::size_t l = 0; l < views.size(); ++l) {
    if (views[l].then.size() < at(options.fewest_views)) continue;
    const Eigen::Vector3d p = map.p_map(map.landmarks[l]);
    if (parallax(views[l].then, p, poses) < options.least_parallax) continue;
    LandmarkRedetection c;
    c.landmark = static_cast<int>(l);
    c.p_map = p;
    c.found = !views[l].now.empty();
    c.views = static_cast<int>(views[l].then.size());
    c.ground = map.landmarks[l].ground;
    add_trials(views[l], chances.size(), p, poses, alike, options, trials);
    chances.push_back(c);
  }
  drop_untrusted(map.keyframes.size(), options.trusted, trials);
  count(trials, chances);
  std::erase_if(chances,
                [&](const LandmarkRedetection& c) { return c.expected < options.least_expected; });
  return chances;
}

void fit_redetection_probabilities(const std::vector<std::uint8_t>& of_use,
                                   std::vector<LandmarkRedetection>& chances) {
  constexpr int kRounds = 15;
  constexpr double kEnough = 1e-10;  // on the squared step
  constexpr double kRidge = 1.0;     // ridge on all but the constant, worth one landmark
  ChanceFeatures w = ChanceFeatures::Zero();
  std::vector<ChanceFeatures> features;
  for (const LandmarkRedetection& c : chances) features.push_back(features_of(c));
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix<double, kFeatures, kFeatures> H =
        Eigen::Matrix<double, kFeatures, kFeatures>::Identity() * kRidge;
    H(0, 0) = 1e-6;
    ChanceFeatures g = -H * w;
    for (std::size_t i = 0; i < chances.size(); ++i) {
      if (of_use[i] == 0) continue;
      const ChanceFeatures& f = features[i];
      const double p = logistic(w.dot(f));
      g += ((chances[i].found ? 1.0 : 0.0) - p) * f;
      H += std::max(p * (1.0 - p), 1e-4) * f * f.transpose();
    }
    const ChanceFeatures step = H.ldlt().solve(g);
    w += step;
    if (step.squaredNorm() < kEnough) break;
  }
  for (std::size_t i = 0; i < chances.size(); ++i)
    chances[i].chance = std::clamp(logistic(w.dot(features[i])), 0.005, 0.995);
}

}  // namespace roadbook
