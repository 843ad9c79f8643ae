#include "diagnosis/view_moments.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace roadbook {
namespace {

constexpr std::int64_t kHalfWindowNs = 60'000'000;

// Cumulative wheel angles at any time, linear between readings.
class WheelAngles {
 public:
  WheelAngles(const Drive& drive, double time_offset_s) : readings_(drive.wheel_readings()) {
    const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * time_offset_s));
    for (WheelReading& r : readings_) r.t_ns += offset_ns;
  }
  [[nodiscard]] std::optional<Eigen::Vector2d> at(std::int64_t t_ns) const {
    const auto after =
        std::lower_bound(readings_.begin(), readings_.end(), t_ns,
                         [](const WheelReading& r, std::int64_t t) { return r.t_ns < t; });
    if (after == readings_.end()) return std::nullopt;
    if (after->t_ns == t_ns) return Eigen::Vector2d(after->left_angle_rad, after->right_angle_rad);
    if (after == readings_.begin()) return std::nullopt;
    const WheelReading& a = *(after - 1);
    const double w = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(after->t_ns - a.t_ns);
    return Eigen::Vector2d(a.left_angle_rad + w * (after->left_angle_rad - a.left_angle_rad),
                           a.right_angle_rad + w * (after->right_angle_rad - a.right_angle_rad));
  }

 private:
  std::vector<WheelReading> readings_;
};

bool from_wheels(const WheelAngles& angles, const WheelModel& model, ViewMoment& m) {
  const auto before = angles.at(m.t_ns - kHalfWindowNs);
  const auto now = angles.at(m.t_ns);
  const auto after = angles.at(m.t_ns + kHalfWindowNs);
  if (!before || !now || !after) return false;
  const double half_s = 1e-9 * static_cast<double>(kHalfWindowNs);
  const auto rates = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double dt) {
    return Eigen::Vector2d(wheel_increment<double>(b.x() - a.x(), b.y() - a.y(),
                                                   model.radius_left_m, model.radius_right_m,
                                                   model.track_width_m) /
                           dt);
  };
  const Eigen::Vector2d mean = rates(*before, *after, 2.0 * half_s);
  m.speed = mean.x();
  m.yaw_rate = mean.y();
  m.left_phase_rad = now->x();
  m.right_phase_rad = now->y();
  const auto long_before = angles.at(m.t_ns - 3 * kHalfWindowNs);
  const auto long_after = angles.at(m.t_ns + 3 * kHalfWindowNs);
  if (long_before && long_after)
    m.acceleration = (rates(*after, *long_after, 2.0 * half_s).x() -
                      rates(*long_before, *before, 2.0 * half_s).x()) /
                     (4.0 * half_s);
  return true;
}

void from_poses(const std::vector<BundlePose>& poses,
                const std::vector<ViewMoment>& moments,
                std::size_t k,
                ViewMoment& m) {
  const std::size_t a = k > 0 ? k - 1 : k;
  const std::size_t b = std::min(k + 1, poses.size() - 1);
  const double dt = 1e-9 * static_cast<double>(moments[b].t_ns - moments[a].t_ns);
  if (dt <= 0.0) return;
  const Vector6d xi = se3_log(poses[a].T_map_vehicle.inverse() * poses[b].T_map_vehicle) / dt;
  m.speed = xi[0];
  m.yaw_rate = xi[5];
}

}  // namespace

std::vector<ViewMoment> view_moments(const std::vector<std::int64_t>& stamps,
                                     const std::vector<BundlePose>& poses,
                                     const Drive& drive) {
  std::vector<ViewMoment> moments(stamps.size());
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    moments[k].t_ns = stamps[k];
    moments[k].t_s = 1e-9 * static_cast<double>(stamps[k] - stamps.front());
  }
  std::optional<WheelAngles> angles;
  if (drive.wheel_model()) angles.emplace(drive, drive.wheel_model()->time_offset_s);
  for (std::size_t k = 0; k < moments.size(); ++k)
    if (!angles || !from_wheels(*angles, *drive.wheel_model(), moments[k]))
      from_poses(poses, moments, k, moments[k]);
  return moments;
}

}  // namespace roadbook
