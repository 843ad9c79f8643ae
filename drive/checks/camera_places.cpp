#include "drive/checks/camera_places.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

namespace roadbook {
namespace {

using Box = Eigen::AlignedBox3d;

constexpr double kBeside_m = 0.8;  // of the body: mirrors, brackets, bull bars

std::string metres_text(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value << " m";
  return text.str();
}

std::string place_text(const Eigen::Vector3d& p) {
  std::ostringstream text;
  text.precision(4);
  text << "at x " << p.x() << ", y " << p.y() << ", z " << p.z() << " m";
  return text.str();
}

// From the wheels alone: overhangs of cars and buses are less than two thirds of the wheelbase.
Box body_of_wheels(const WheelModel& wheels) {
  const double half_width = 0.5 * wheels.track_width_m + 0.2;
  return {Eigen::Vector3d(-0.6 * wheels.wheelbase_m, -half_width, 0.0),
          Eigen::Vector3d(1.6 * wheels.wheelbase_m, half_width,
                          std::numeric_limits<double>::infinity())};
}

// Share of the body that a view along `axis` from the skin or from within passes through, seen from
// above.
double share_passed(const Eigen::Vector3d& from, const Eigen::Vector3d& axis, const Box& body) {
  const Eigen::Vector2d along = axis.head<2>().normalized();
  double enter = 0.0;
  double leave = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 2; ++k) {
    if (std::abs(along[k]) < 1e-9) {
      if (from[k] <= body.min()[k] || from[k] >= body.max()[k]) return 0.0;
      continue;
    }
    const double a = (body.min()[k] - from[k]) / along[k];
    const double b = (body.max()[k] - from[k]) / along[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  const Eigen::Vector2d size = body.sizes().head<2>();
  const double whole = along.cwiseAbs().dot(size);
  return leave > enter ? (leave - enter) / whole : 0.0;
}

// A camera on the outer skin below the windows that looks across the vehicle to its other side.
bool looks_into_body(const Eigen::Vector3d& at, const Eigen::Vector3d& axis, const Box& body) {
  constexpr double kSkin_m = 0.3;
  const double roof = std::min(body.max().z(), 1.5);
  if (at.z() > 0.7 * roof || axis.head<2>().norm() < 0.2) return false;
  const bool inside = (at.head<2>() - body.min().head<2>()).minCoeff() > kSkin_m &&
                      (body.max().head<2>() - at.head<2>()).minCoeff() > kSkin_m;
  return !inside && share_passed(at, axis, body) > 0.6;
}

std::string inverse_hint(bool inverse) {
  return inverse ? "; the inverse of T_BS is a likely pose (Kalibr's T_cam_imu is the inverse)"
                 : "";
}

}  // namespace

std::string mounting_fault(const Eigen::Isometry3d& T_vehicle_camera,
                           const Eigen::AlignedBox3d& body) {
  constexpr double kHighest_m = 5.0;
  constexpr double kUnderGround_m = -0.05;
  constexpr double kSky = 0.87;  // sine of 60 degrees above the horizon
  const Eigen::Vector3d at = T_vehicle_camera.translation();
  const Eigen::Vector3d axis = T_vehicle_camera.linear().col(2);
  if (at.z() < kUnderGround_m) return metres_text(-at.z()) + " below the ground";
  if (at.z() > kHighest_m) return metres_text(at.z()) + " above the ground";
  const Eigen::AlignedBox2d outline(body.min().head<2>(), body.max().head<2>());
  const double outside = outline.exteriorDistance(Eigen::Vector2d(at.head<2>()));
  if (outside > kBeside_m) return metres_text(outside) + " outside the vehicle's body";
  if (axis.z() > kSky) return "with a view into the sky";
  if (looks_into_body(at, axis, body)) return "with a view through the vehicle's own body";
  return "";
}

bool is_outside_fault(const std::string& fault) {
  return fault.find("outside the vehicle's body") != std::string::npos;
}

void warn_of_camera_places(const std::filesystem::path& sensors,
                           const Rig& rig,
                           const std::optional<WheelModel>& wheels,
                           const std::optional<VehicleMeasures>& vehicle,
                           ProblemList& problems) {
  constexpr double kToldElsewhere_m = 12.0;  // check_camera_sizes
  auto body = vehicle ? vehicle->body() : std::nullopt;
  if (!body && wheels) body = body_of_wheels(*wheels);
  const bool known_frame = body.has_value();
  // Any car: seen from another body's frame, its ground may lie anywhere near.
  if (!body) body = body_of_wheels(WheelModel{});
  std::vector<std::string> faults;
  std::size_t likely_inverses = 0;
  std::size_t unlikely = 0;
  std::size_t far_below = 0;
  for (const MountedCamera& camera : rig.cameras) {
    faults.push_back(mounting_fault(camera.T_vehicle_camera, *body));
    unlikely += faults.back().empty() ? 0 : 1;
    far_below += camera.T_vehicle_camera.translation().z() < -0.3 ? 1 : 0;
    likely_inverses += mounting_fault(camera.T_vehicle_camera.inverse(), *body).empty() ? 1 : 0;
  }
  const std::size_t count = rig.cameras.size();
  const bool most =
      known_frame ? 2 * unlikely > count : unlikely == count && 2 * far_below >= count;
  const bool inverse = most && likely_inverses == count;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const Eigen::Vector3d at = rig.cameras[i].T_vehicle_camera.translation();
    if (faults[i].empty() || at.norm() > kToldElsewhere_m || !(known_frame || inverse)) continue;
    if (!inverse && vehicle && vehicle->body() && is_outside_fault(faults[i])) continue;
    problems.warning(
        (sensors / rig.cameras[i].name / "sensor.yaml").string(), 0, "T_BS",
        rig.cameras[i].name + " " + place_text(at) + ", " + faults[i] + inverse_hint(inverse),
        "a camera on the vehicle that looks out of it");
  }
}

}  // namespace roadbook
