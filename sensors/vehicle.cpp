#include "sensors/vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace roadbook {
namespace {

constexpr double kWidthBesideTrackM = 0.25;
constexpr double kRearShareOfLength = 0.2;
constexpr std::array<std::string_view, 4> kSourceNames{"none", "measured", "file", "option"};

std::optional<double> length_or_estimate(const VehicleMeasures& v) {
  if (v.length_m) return v.length_m;
  if (v.wheelbase_m && v.rear_overhang_m) return *v.wheelbase_m + 2.0 * *v.rear_overhang_m;
  return std::nullopt;
}

double rear_or_estimate(const VehicleMeasures& v, double length_m) {
  if (v.rear_overhang_m) return *v.rear_overhang_m;
  if (v.wheelbase_m) return 0.5 * (length_m - *v.wheelbase_m);
  return kRearShareOfLength * length_m;
}

}  // namespace

std::optional<double> VehicleMeasures::front_overhang_m() const {
  if (!length_m || !rear_overhang_m || !wheelbase_m) return std::nullopt;
  return *length_m - *rear_overhang_m - *wheelbase_m;
}

std::optional<double> VehicleMeasures::width_or_estimate_m() const {
  if (width_m) return width_m;
  if (track_width_m) return *track_width_m + kWidthBesideTrackM;
  return std::nullopt;
}

std::optional<Eigen::AlignedBox3d> VehicleMeasures::body() const {
  const auto length = length_or_estimate(*this);
  const auto width = width_or_estimate_m();
  if (!length || !width) return std::nullopt;
  const double rear = rear_or_estimate(*this, *length);
  const double top = height_m.value_or(std::numeric_limits<double>::infinity());
  return Eigen::AlignedBox3d(Eigen::Vector3d(-rear, -0.5 * *width, 0.0),
                             Eigen::Vector3d(*length - rear, 0.5 * *width, top));
}

std::string_view vehicle_source_name(VehicleSource source) {
  return kSourceNames[static_cast<std::size_t>(source)];
}

std::optional<VehicleSource> vehicle_source_from(std::string_view name) {
  for (std::size_t i = 0; i < kSourceNames.size(); ++i)
    if (kSourceNames[i] == name) return static_cast<VehicleSource>(i);
  return std::nullopt;
}

Eigen::AlignedBox3d body_or_outline(const VehicleMeasures& vehicle, const Rig& rig) {
  if (const auto body = vehicle.body()) return *body;
  Eigen::AlignedBox3d outline;
  for (const MountedCamera& mounted : rig.cameras)
    outline.extend(mounted.T_vehicle_camera.translation());
  if (outline.isEmpty()) return outline;
  outline.max().z() = std::max(0.0, outline.min().z());
  outline.min().z() = 0.0;
  return outline;
}

bool is_above_body(const Eigen::AlignedBox3d& body, const Eigen::Vector3d& p_vehicle) {
  return p_vehicle.x() > body.min().x() && p_vehicle.x() < body.max().x() &&
         p_vehicle.y() > body.min().y() && p_vehicle.y() < body.max().y();
}

bool is_hidden_by_body(const Eigen::AlignedBox3d& body,
                       const Eigen::Vector3d& centre_vehicle,
                       const Eigen::Vector3d& p_vehicle) {
  if (is_above_body(body, p_vehicle)) return true;
  if (is_above_body(body, centre_vehicle)) return false;
  // Slab test of the line of sight against the body.
  double enter = 0.0;
  double leave = 1.0;
  const Eigen::Vector3d d = p_vehicle - centre_vehicle;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(d[axis]) < 1e-9) {
      if (centre_vehicle[axis] < body.min()[axis] || centre_vehicle[axis] > body.max()[axis])
        return false;
      continue;
    }
    double a = (body.min()[axis] - centre_vehicle[axis]) / d[axis];
    double b = (body.max()[axis] - centre_vehicle[axis]) / d[axis];
    if (a > b) std::swap(a, b);
    enter = std::max(enter, a);
    leave = std::min(leave, b);
  }
  return enter < leave;
}

}  // namespace roadbook
