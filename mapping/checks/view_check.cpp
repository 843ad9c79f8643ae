#include "mapping/checks/view_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/format.hpp"
#include "base/index.hpp"
#include "base/median.hpp"
#include "mapping/checks/finding.hpp"

namespace roadbook {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::infinity();
// Of the median error of all observations. In sound maps the worst poses have three times as much.
constexpr double kFactor = 8.0;
constexpr double kLeastPx = 4.0;  // [px, full-size image]
constexpr int kLeastViews = 8;    // of a pose, to judge it

// Length of each observation's error [px]; infinite where the camera cannot see the landmark.
std::vector<double> errors_of_observations(const Map& map) {
  std::vector<double> errors;
  errors.reserve(map.observations.size());
  for (const Observation& o : map.observations) {
    const Keyframe& keyframe = map.keyframes[at(o.keyframe)];
    const MountedCamera& mounted = map.sessions[at(keyframe.session)].rig.cameras[at(o.camera)];
    const Eigen::Vector3d p = (map.T_map_vehicle(o.keyframe) * mounted.T_vehicle_camera).inverse() *
                              map.p_map(map.landmarks[at(o.landmark)]);
    const auto pixel = mounted.camera.project(p);
    errors.push_back(pixel ? (*pixel - o.pixel.cast<double>()).norm() : kUnseen);
  }
  return errors;
}

std::string pixels_text(double error) {
  return std::isinf(error) ? "landmarks that it cannot see" : fixed(error, 1) + " px";
}

using CameraOfSession = std::pair<int, int>;

std::set<CameraOfSession> find_wrong_cameras(const Map& map,
                                             const std::vector<double>& errors,
                                             double most_px,
                                             std::vector<Problem>& problems) {
  std::map<CameraOfSession, std::vector<double>> of_camera;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Observation& o = map.observations[i];
    of_camera[{map.keyframes[at(o.keyframe)].session, o.camera}].push_back(errors[i]);
  }
  std::set<CameraOfSession> wrong;
  for (const auto& [camera, list] : of_camera) {
    const double middle = median(list);
    if (static_cast<int>(list.size()) < kLeastViews || middle <= most_px) continue;
    wrong.insert(camera);
    const Session& session = map.sessions[at(camera.first)];
    problems.push_back(finding(
        "camera " + session.rig.cameras[at(camera.second)].name + " of session " + session.name,
        "a median error of " + pixels_text(middle) + " over " + std::to_string(list.size()) +
            " observations",
        "at most " + fixed(most_px, 1) +
            " px, as the other cameras (is it mounted or "
            "calibrated otherwise?)"));
  }
  return wrong;
}

std::set<int> find_wrong_poses(const Map& map,
                               const std::vector<double>& errors,
                               const std::set<CameraOfSession>& wrong_cameras,
                               double most_px,
                               std::vector<Problem>& problems) {
  std::vector<std::vector<double>> of_pose(map.keyframes.size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Observation& o = map.observations[i];
    if (!wrong_cameras.contains({map.keyframes[at(o.keyframe)].session, o.camera}))
      of_pose[at(o.keyframe)].push_back(errors[i]);
  }
  std::set<int> wrong;
  std::map<int, std::vector<int>> of_session;
  for (std::size_t k = 0; k < of_pose.size(); ++k) {
    if (static_cast<int>(of_pose[k].size()) < kLeastViews) continue;
    if (median(of_pose[k]) <= most_px) continue;
    wrong.insert(static_cast<int>(k));
    of_session[map.keyframes[k].session].push_back(static_cast<int>(k));
  }
  for (const auto& [session, keyframes] : of_session)
    problems.push_back(finding("poses of session " + map.sessions[at(session)].name,
                               std::to_string(keyframes.size()) + " keyframes (" +
                                   first_of(keyframes) + ") where their landmarks are not seen",
                               "a median error of at most " + fixed(most_px, 1) + " px"));
  return wrong;
}

void find_unseen_landmarks(const Map& map,
                           const std::vector<double>& errors,
                           const std::set<CameraOfSession>& wrong_cameras,
                           const std::set<int>& wrong_poses,
                           std::vector<Problem>& problems) {
  std::set<int> unseen;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const Observation& o = map.observations[i];
    if (std::isinf(errors[i]) && !wrong_poses.contains(o.keyframe) &&
        !wrong_cameras.contains({map.keyframes[at(o.keyframe)].session, o.camera}))
      unseen.insert(o.landmark);
  }
  if (unseen.empty()) return;
  problems.push_back(finding("landmarks " + first_of({unseen.begin(), unseen.end()}),
                             "behind or beside a camera that observed them",
                             "landmarks in view of their cameras"));
}

void find_double_views(const Map& map, std::vector<Problem>& problems) {
  std::set<std::tuple<int, int, int>> seen;
  std::set<int> twice;
  for (const Observation& o : map.observations)
    if (!seen.insert({o.landmark, o.keyframe, o.camera}).second) twice.insert(o.landmark);
  if (!twice.empty())
    problems.push_back(finding("landmarks " + first_of({twice.begin(), twice.end()}),
                               "two observations in one image", "at most one"));
}

}  // namespace

std::vector<Problem> view_problems(const Map& map) {
  std::vector<Problem> problems;
  find_double_views(map, problems);
  if (map.observations.empty()) return problems;
  const std::vector<double> errors = errors_of_observations(map);
  const double most_px = std::max(kLeastPx, kFactor * median(errors));
  const auto cameras = find_wrong_cameras(map, errors, most_px, problems);
  const auto poses = find_wrong_poses(map, errors, cameras, most_px, problems);
  find_unseen_landmarks(map, errors, cameras, poses, problems);
  return problems;
}

}  // namespace roadbook
