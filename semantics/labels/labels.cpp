#include "semantics/labels/labels.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Ground area under the vehicle of each session, vehicle frame.
std::vector<Eigen::AlignedBox3d> bodies_of(const Map& map) {
  std::vector<Eigen::AlignedBox3d> bodies;
  for (const Session& session : map.sessions)
    bodies.push_back(body_or_outline(session.vehicle, session.rig));
  return bodies;
}

// The point of the vehicle's ground plane above or below a place of the map, vehicle frame.
Eigen::Vector3d on_vehicle_plane(const Eigen::Isometry3d& T_map_vehicle, const Eigen::Vector2d& p) {
  const Eigen::Vector3d normal = T_map_vehicle.linear().col(2);
  const Eigen::Vector3d origin = T_map_vehicle.translation();
  Eigen::Vector3d on_plane(p.x(), p.y(), 0.0);
  on_plane.z() =
      origin.z() -
      (normal.x() * (p.x() - origin.x()) + normal.y() * (p.y() - origin.y())) / normal.z();
  Eigen::Vector3d p_vehicle = T_map_vehicle.inverse() * on_plane;
  p_vehicle.z() = 0.0;
  return p_vehicle;
}

Eigen::Isometry3d required_vehicle(const Map& map, const LabelAnchor& anchor) {
  const auto vehicle = vehicle_of(map, anchor);
  if (!vehicle)
    throw InvalidOption(
        "anchor", std::to_string(anchor.t_ns) + " of session " + std::to_string(anchor.session),
        "a time with a pose in the map");
  return vehicle->T_map_vehicle;
}

using Keyframes = std::vector<Keyframe>;

// The first keyframe of the anchor's session at or after the anchor's time, or
// the entry of `map.keyframes` after the session.
Keyframes::const_iterator first_from(const Map& map, const LabelAnchor& anchor) {
  const auto before = [](const Keyframe& k, const LabelAnchor& a) {
    return std::pair(k.session, k.t_ns) < std::pair(a.session, a.t_ns);
  };
  return std::lower_bound(map.keyframes.begin(), map.keyframes.end(), anchor, before);
}

// Angle between the optical axis and the middle of the points. Empty if the camera does not see all
// points.
std::optional<double> off_axis(const MountedCamera& mounted,
                               const std::vector<Eigen::Vector3d>& points_vehicle,
                               double max_range_m) {
  const Eigen::Isometry3d T_camera_vehicle = mounted.T_vehicle_camera.inverse();
  for (const auto& p : points_vehicle) {
    const auto pixel = mounted.camera.project(T_camera_vehicle * p);
    if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > mounted.camera.width - 1 ||
        pixel->y() > mounted.camera.height - 1)
      return std::nullopt;
  }
  const Eigen::Vector3d middle = T_camera_vehicle * points_vehicle.back();
  if (middle.norm() > max_range_m) return std::nullopt;
  return std::atan2(middle.head<2>().norm(), middle.z());
}

constexpr double kCameraReachM = 5.0;  // distance between a camera and the vehicle's origin

// Calls `found(anchor, angle)` for every image that sees all corners. Tests all keyframes if
// `index` is null.
template <class Found>
void for_each_view(const Map& map,
                   const KeyframeIndex* index,
                   const std::vector<Eigen::Vector2d>& corners,
                   const AnchorOptions& options,
                   const Found& found) {
  if (corners.empty()) return;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const auto& corner : corners) middle += corner / static_cast<double>(corners.size());
  const auto bodies = bodies_of(map);
  const double reach_m = options.max_range_m + kCameraReachM;
  const auto near = index != nullptr ? index->within(middle, reach_m) : std::vector<std::size_t>();
  const std::size_t count = index != nullptr ? near.size() : map.keyframes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = index != nullptr ? near[i] : i;
    const Eigen::Isometry3d T_map_vehicle = map.T_map_vehicle(static_cast<int>(k));
    if ((T_map_vehicle.translation().head<2>() - middle).norm() > reach_m) continue;
    std::vector<Eigen::Vector3d> points;
    for (const auto& corner : corners) points.push_back(on_vehicle_plane(T_map_vehicle, corner));
    points.push_back(on_vehicle_plane(T_map_vehicle, middle));
    const Keyframe& keyframe = map.keyframes[k];
    const Eigen::AlignedBox3d& body = bodies[static_cast<std::size_t>(keyframe.session)];
    if (std::any_of(points.begin(), points.end(),
                    [&](const Eigen::Vector3d& p) { return is_above_body(body, p); }))
      continue;
    const auto& cameras = map.sessions[static_cast<std::size_t>(keyframe.session)].rig.cameras;
    for (std::size_t c = 0; c < cameras.size(); ++c)
      if (const auto angle = off_axis(cameras[c], points, options.max_range_m))
        found(LabelAnchor{keyframe.session, keyframe.t_ns, static_cast<int>(c)}, *angle);
  }
}

std::optional<LabelAnchor> most_central(const Map& map,
                                        const KeyframeIndex* index,
                                        const std::vector<Eigen::Vector2d>& corners,
                                        const AnchorOptions& options) {
  std::optional<LabelAnchor> best;
  double least = std::numeric_limits<double>::max();
  double of_now = std::numeric_limits<double>::max();
  for_each_view(map, index, corners, options, [&](const LabelAnchor& view, double angle) {
    if (options.now == view) of_now = angle;
    if (angle >= least) return;
    least = angle;
    best = view;
  });
  return best && of_now <= least + options.as_central_rad ? options.now : best;
}

std::optional<LabelAnchor> near_or_far_anchor(const Map& map,
                                              const KeyframeIndex* index,
                                              const std::vector<Eigen::Vector2d>& corners,
                                              const std::optional<LabelAnchor>& now) {
  constexpr double kFarthestM = 30.0;
  AnchorOptions options{.now = now};
  if (auto near = most_central(map, index, corners, options)) return near;
  options.max_range_m = kFarthestM;
  return most_central(map, index, corners, options);
}

}  // namespace

Eigen::Vector3d middle_of(const Label& label) {
  if (label.shape == LabelShape::kBox) return label.T_vehicle_label.translation();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& corner : label.corners_vehicle) sum += corner;
  return sum / static_cast<double>(std::max<std::size_t>(1, label.corners_vehicle.size()));
}

std::optional<TrackPose> vehicle_of(const Map& map, const LabelAnchor& anchor) {
  return track_pose(map, anchor.session, anchor.t_ns);
}

std::optional<int> keyframe_of(const Map& map, const LabelAnchor& anchor) {
  const auto found = first_from(map, anchor);
  if (found == map.keyframes.end() || found->session != anchor.session ||
      found->t_ns != anchor.t_ns)
    return std::nullopt;
  return static_cast<int>(found - map.keyframes.begin());
}

std::optional<int> nearest_keyframe_of(const Map& map, const LabelAnchor& anchor) {
  const auto next = first_from(map, anchor);
  std::optional<int> nearest;
  std::int64_t least = 0;
  const auto consider = [&](Keyframes::const_iterator k) {
    const std::int64_t apart = std::abs(k->t_ns - anchor.t_ns);
    if (k->session != anchor.session || (nearest && apart >= least)) return;
    nearest = static_cast<int>(k - map.keyframes.begin());
    least = apart;
  };
  if (next != map.keyframes.begin()) consider(std::prev(next));
  if (next != map.keyframes.end()) consider(next);
  return nearest;
}

std::optional<OrientedBox> box_in_map(const Map& map, const Label& label) {
  const auto vehicle = vehicle_of(map, label.anchor);
  if (!vehicle || label.shape != LabelShape::kBox) return std::nullopt;
  const Eigen::Isometry3d T_map_label = vehicle->T_map_vehicle * label.T_vehicle_label;
  OrientedBox box;
  box.centre = T_map_label.translation().head<2>();
  box.heading = std::atan2(T_map_label.linear()(1, 0), T_map_label.linear()(0, 0));
  box.length_m = label.length_m;
  box.width_m = label.width_m;
  return box;
}

std::vector<Eigen::Vector3d> corners_of(const Label& label) {
  if (label.shape == LabelShape::kPolygon) return label.corners_vehicle;
  if (label.shape != LabelShape::kBox) return {};
  const double l = 0.5 * label.length_m;
  const double w = 0.5 * label.width_m;
  std::vector<Eigen::Vector3d> corners;
  for (const auto& [x, y] : {std::pair{l, -w}, {l, w}, {-l, w}, {-l, -w}})
    corners.push_back(label.T_vehicle_label * Eigen::Vector3d(x, y, 0.0));
  return corners;
}

std::vector<Eigen::Vector3d> corners_in_map(const Map& map, const Label& label) {
  const auto vehicle = vehicle_of(map, label.anchor);
  if (!vehicle) return {};
  std::vector<Eigen::Vector3d> corners = corners_of(label);
  for (Eigen::Vector3d& corner : corners) corner = vehicle->T_map_vehicle * corner;
  return corners;
}

std::optional<Eigen::Matrix2d> covariance_in_map(const Map& map, const Label& label) {
  const auto vehicle = vehicle_of(map, label.anchor);
  if (!vehicle || !is_on_ground(label) || !is_known(vehicle->covariance)) return std::nullopt;
  return covariance_of_point(*vehicle, middle_of(label)) +
         label.sigma_m * label.sigma_m * Eigen::Matrix2d::Identity();
}

std::optional<double> sigma_in_map(const Map& map, const Label& label) {
  const auto covariance = covariance_in_map(map, label);
  if (!covariance) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(*covariance);
  return std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
}

std::optional<LabelSeen> seen_in_map(const Map& map, const Label& label) {
  const auto vehicle = vehicle_of(map, label.anchor);
  if (!vehicle || !is_on_ground(label)) return std::nullopt;
  const Eigen::Vector3d middle = vehicle->T_map_vehicle * middle_of(label);
  return LabelSeen{middle.head<2>(),
                   covariance_in_map(map, label).value_or(unknown_covariance<Eigen::Matrix2d>()),
                   static_cast<int>(map.sessions.size())};
}

Label label_of_box(const Map& map, const LabelAnchor& anchor, const OrientedBox& box) {
  const Eigen::Isometry3d T_map_vehicle = required_vehicle(map, anchor);
  Label label;
  label.anchor = anchor;
  label.shape = LabelShape::kBox;
  label.length_m = box.length_m;
  label.width_m = box.width_m;
  const Eigen::Vector3d middle = on_vehicle_plane(T_map_vehicle, box.centre);
  // The heading is defined in the ground plane of the map. A second point ahead, projected to the
  // vehicle's plane, gives the direction there.
  const Eigen::Vector2d along(std::cos(box.heading), std::sin(box.heading));
  const Eigen::Vector3d ahead = on_vehicle_plane(T_map_vehicle, box.centre + along) - middle;
  label.T_vehicle_label.translation() = middle;
  label.T_vehicle_label.linear() =
      Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  return label;
}

Label label_of_polygon(const Map& map,
                       const LabelAnchor& anchor,
                       const std::vector<Eigen::Vector2d>& corners) {
  if (corners.size() < 3)
    throw InvalidOption("polygon", std::to_string(corners.size()) + " corners", "3 or more");
  const Eigen::Isometry3d T_map_vehicle = required_vehicle(map, anchor);
  Label label;
  label.anchor = anchor;
  label.shape = LabelShape::kPolygon;
  for (const auto& corner : corners)
    label.corners_vehicle.push_back(on_vehicle_plane(T_map_vehicle, corner));
  return label;
}

std::optional<LabelAnchor> most_central_view(const Map& map,
                                             const std::vector<Eigen::Vector2d>& corners,
                                             const AnchorOptions& options) {
  return most_central(map, nullptr, corners, options);
}

std::vector<LabelAnchor> central_views(const Map& map,
                                       const std::vector<Eigen::Vector2d>& corners,
                                       int session,
                                       const AnchorOptions& options) {
  std::vector<std::pair<double, LabelAnchor>> views;
  for_each_view(map, nullptr, corners, options, [&](const LabelAnchor& view, double angle) {
    if (view.session == session) views.emplace_back(angle, view);
  });
  std::stable_sort(views.begin(), views.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  constexpr double kApartM = 0.5;
  const auto place_of = [&](const LabelAnchor& view) -> Eigen::Vector3d {
    return map.T_map_vehicle(*keyframe_of(map, view)).translation();
  };
  std::vector<LabelAnchor> kept;
  for (const auto& [angle, view] : views)
    if (std::none_of(kept.begin(), kept.end(), [&, &v = view](const LabelAnchor& other) {
          return other.camera == v.camera && (place_of(other) - place_of(v)).norm() < kApartM;
        }))
      kept.push_back(view);
  return kept;
}

std::optional<LabelAnchor> anchor_for(const Map& map,
                                      const std::vector<Eigen::Vector2d>& corners,
                                      const std::optional<LabelAnchor>& now) {
  return near_or_far_anchor(map, nullptr, corners, now);
}

std::optional<LabelAnchor> anchor_for(const KeyframeIndex& keyframes,
                                      const std::vector<Eigen::Vector2d>& corners,
                                      const std::optional<LabelAnchor>& now) {
  return near_or_far_anchor(keyframes.map(), &keyframes, corners, now);
}

}  // namespace roadbook
