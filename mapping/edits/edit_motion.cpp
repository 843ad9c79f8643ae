#include "mapping/edits/edit_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/format.hpp"
#include "base/index.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

constexpr std::int64_t kNearNs = 1'000'000'000;
constexpr double kSamePixelPx = 6.0;    // between a pixel of an edit and an observation
constexpr double kGroundReachM = 25.0;  // of a pixel on the ground
constexpr double kMostMisfitM = 0.5;
constexpr double kLeastSigmaM = 0.05;
constexpr double kHeightSigmaM = 0.1;  // of what a motion in the plane does not say
constexpr double kTiltSigmaRad = 0.02;

std::string session_names(const Map& map) {
  std::string names;
  for (const Session& session : map.sessions) names += (names.empty() ? "" : ", ") + session.name;
  return names;
}

int camera_named(const Map& map, int keyframe, const std::string& name) {
  const Session& session = map.sessions[at(map.keyframes[at(keyframe)].session)];
  std::string names;
  for (std::size_t c = 0; c < session.rig.cameras.size(); ++c) {
    if (session.rig.cameras[c].name == name) return static_cast<int>(c);
    names += (names.empty() ? "" : ", ") + session.rig.cameras[c].name;
  }
  throw BadInput({Severity::kError, "", 0, "camera", name, "one of " + names});
}

// The point that a pixel shows, in the vehicle frame of its keyframe.
std::optional<Eigen::Vector3d> point_at(const Map& map,
                                        int keyframe,
                                        int camera,
                                        const Eigen::Vector2d& pixel) {
  const Observation* nearest = nullptr;
  double least = kSamePixelPx;
  for (const Observation& o : map.observations) {
    if (o.keyframe != keyframe || o.camera != camera) continue;
    const double distance = (o.pixel.cast<double>() - pixel).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = &o;
  }
  if (nearest != nullptr)
    return map.T_map_vehicle(keyframe).inverse() * map.p_map(map.landmarks[at(nearest->landmark)]);
  const MountedCamera& mounted =
      map.sessions[at(map.keyframes[at(keyframe)].session)].rig.cameras[at(camera)];
  const auto ray = mounted.camera.bearing(pixel);
  if (!ray) return std::nullopt;
  const Eigen::Vector3d direction = mounted.T_vehicle_camera.linear() * *ray;
  const Eigen::Vector3d origin = mounted.T_vehicle_camera.translation();
  if (direction.z() >= -1e-3) return std::nullopt;
  const Eigen::Vector3d p = origin - direction * (origin.z() / direction.z());
  return p.head<2>().norm() <= kGroundReachM ? std::optional(p) : std::nullopt;
}

RelativePose planar_motion(
    int from, int to, const Eigen::Vector3d& motion, double sigma_m, double sigma_rad) {
  RelativePose edge;
  edge.from = from;
  edge.to = to;
  edge.T_from_to = pose_from_planar(motion.x(), motion.y(), motion.z());
  edge.information.setZero();
  edge.information.diagonal() << 1.0 / (sigma_m * sigma_m), 1.0 / (sigma_m * sigma_m),
      1.0 / (kHeightSigmaM * kHeightSigmaM), 1.0 / (kTiltSigmaRad * kTiltSigmaRad),
      1.0 / (kTiltSigmaRad * kTiltSigmaRad), 1.0 / (sigma_rad * sigma_rad);
  return edge;
}

RelativePose motion_of_points(const Map& map, const MapEdit& edit, int a, int b) {
  const int camera_a = camera_named(map, a, edit.camera_a);
  const int camera_b = camera_named(map, b, edit.camera_b);
  std::vector<Eigen::Vector2d> in_a;
  std::vector<Eigen::Vector2d> in_b;
  for (std::size_t i = 0; i < edit.pixels_a.size(); ++i) {
    const auto p_a = point_at(map, a, camera_a, edit.pixels_a[i]);
    const auto p_b = point_at(map, b, camera_b, edit.pixels_b[i]);
    if (!p_a || !p_b) continue;
    in_a.emplace_back(p_a->head<2>());
    in_b.emplace_back(p_b->head<2>());
  }
  const auto count = static_cast<double>(in_a.size());
  if (in_a.size() < 2)
    throw Refused("error: edit: " + text_of(edit) + ": got " + std::to_string(in_a.size()) +
                  " points with a known place, want two or more landmarks or points on the ground");
  Eigen::Vector2d mean_a = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_b = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    mean_a += in_a[i] / count;
    mean_b += in_b[i] / count;
  }
  double along = 0.0;
  double across = 0.0;
  double spread = 0.0;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    const Eigen::Vector2d p = in_a[i] - mean_a;
    const Eigen::Vector2d q = in_b[i] - mean_b;
    along += q.dot(p);
    across += q.x() * p.y() - q.y() * p.x();
    spread += p.squaredNorm() / count;
  }
  const double heading = std::atan2(across, along);
  const Eigen::Rotation2Dd turn(heading);
  const Eigen::Vector2d shift = mean_a - turn * mean_b;
  double misfit = 0.0;
  for (std::size_t i = 0; i < in_a.size(); ++i)
    misfit += (turn * in_b[i] + shift - in_a[i]).squaredNorm() / count;
  misfit = std::sqrt(misfit);
  if (misfit > kMostMisfitM)
    throw Refused("error: edit: " + text_of(edit) + ": got points that miss each other by " +
                  fixed(misfit, 2) + " m, want pixels of the same points in the same order");
  const double sigma_m = std::max({kLeastSigmaM, edit.sigma_m / std::sqrt(count), misfit});
  const double sigma_rad = sigma_m / std::max(0.5, std::sqrt(spread));
  return planar_motion(a, b, {shift.x(), shift.y(), heading}, sigma_m, sigma_rad);
}

}  // namespace

std::string text_of(const MapEdit& edit) {
  const auto place = [](const EditPlace& p) { return p.session + "@" + std::to_string(p.t_ns); };
  switch (edit.kind) {
    case EditKind::kLoop:
      return "loop " + place(edit.a) + " - " + place(edit.b);
    case EditKind::kSamePoints:
      return "same_points " + place(edit.a) + " - " + place(edit.b);
    case EditKind::kNotALoop:
      return "not_a_loop " + place(edit.a) + " - " + place(edit.b);
    case EditKind::kAnchor:
      return "anchor " + place(edit.a);
  }
  return {};
}

int keyframe_of_place(const Map& map, const EditPlace& place) {
  const auto found = std::find_if(map.sessions.begin(), map.sessions.end(),
                                  [&](const Session& s) { return s.name == place.session; });
  if (found == map.sessions.end())
    throw BadInput(
        {Severity::kError, "", 0, "session", place.session, "one of " + session_names(map)});
  const int session = static_cast<int>(found - map.sessions.begin());
  int best = -1;
  std::int64_t least = kNearNs + 1;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (map.keyframes[k].session != session) continue;
    const std::int64_t apart = std::abs(map.keyframes[k].t_ns - place.t_ns);
    if (apart >= least) continue;
    least = apart;
    best = static_cast<int>(k);
  }
  if (best < 0)
    throw BadInput({Severity::kError, "", 0, "time in " + place.session, std::to_string(place.t_ns),
                    "within 1 s of a keyframe, from " + std::to_string(found->t_begin_ns) + " to " +
                        std::to_string(found->t_end_ns) + " ns"});
  return best;
}

RelativePose motion_of_edit(const Map& map, const MapEdit& edit) {
  const int a = keyframe_of_place(map, edit.a);
  const int b = keyframe_of_place(map, edit.b);
  if (a == b)
    throw BadInput({Severity::kError, "", 0, text_of(edit), "one keyframe", "two places"});
  RelativePose edge = edit.kind == EditKind::kSamePoints
                          ? motion_of_points(map, edit, a, b)
                          : planar_motion(a, b, edit.motion, edit.sigma_m, edit.sigma_rad);
  if (edge.from < edge.to) return edge;
  std::swap(edge.from, edge.to);
  edge.T_from_to = Eigen::Isometry3d(edge.T_from_to.inverse());
  return edge;
}

}  // namespace roadbook
