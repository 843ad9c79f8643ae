#include "diagnosis/views/view_moments.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/numerics/smoothed_rate.hpp"

namespace roadbook {
namespace {

constexpr double kSlowest = 0.1;  // [m/s] below it the noise of a wheel is taken as constant

// Wheel readings with stamps converted to the clock of the drive.
std::vector<WheelReading> stamped(const Drive& drive, double time_offset_s) {
  std::vector<WheelReading> readings = drive.wheel_readings();
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * time_offset_s));
  for (WheelReading& r : readings) r.t_ns += offset_ns;
  return readings;
}

// Speed and yaw rate between wheel readings. The noise of wheels is a random walk over distance.
class WheelMoments {
 public:
  WheelMoments(const std::vector<WheelReading>& readings, const WheelModel& model)
      : readings_(readings),
        speed_(rates(readings, model, 0)),
        yaw_rate_(rates(readings, model, 1)) {}

  bool fill(ViewMoment& m) const {
    const auto after =
        std::lower_bound(readings_.begin(), readings_.end(), m.t_ns,
                         [](const WheelReading& r, std::int64_t t) { return r.t_ns < t; });
    if (after == readings_.end() || after == readings_.begin()) return false;
    const WheelReading& a = *(after - 1);
    const double w =
        static_cast<double>(m.t_ns - a.t_ns) / static_cast<double>(after->t_ns - a.t_ns);
    m.left_phase_rad = a.left_angle_rad + w * (after->left_angle_rad - a.left_angle_rad);
    m.right_phase_rad = a.right_angle_rad + w * (after->right_angle_rad - a.right_angle_rad);
    const Eigen::Vector2d v = speed_.at(m.t_ns);
    const Eigen::Vector2d yaw = yaw_rate_.at(m.t_ns);
    m.speed = v[0];
    m.acceleration = v[1];
    m.yaw_rate = yaw[0];
    m.yaw_acceleration = yaw[1];
    m.read_by_wheels = true;
    return true;
  }

 private:
  static std::vector<RateReading> rates(const std::vector<WheelReading>& readings,
                                        const WheelModel& model,
                                        Eigen::Index which) {
    std::vector<RateReading> rates;
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const WheelReading& a = readings[i - 1];
      const WheelReading& b = readings[i];
      const double dt = 1e-9 * static_cast<double>(b.t_ns - a.t_ns);
      if (dt <= 0.0) continue;
      const auto moved = wheel_increment<double>(
          b.left_angle_rad - a.left_angle_rad, b.right_angle_rad - a.right_angle_rad,
          model.radius_left_m, model.radius_right_m, model.track_width_m);
      const double speed = std::max(kSlowest, std::abs(moved.x()) / dt);
      rates.push_back({a.t_ns + (b.t_ns - a.t_ns) / 2, moved[which] / dt, speed / dt});
    }
    return rates;
  }
  const std::vector<WheelReading>& readings_;
  SmoothedRate speed_, yaw_rate_;
};

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
  std::optional<WheelMoments> rates;
  std::vector<WheelReading> readings;
  if (drive.wheel_model()) readings = stamped(drive, drive.wheel_model()->time_offset_s);
  if (readings.size() > 2) rates.emplace(readings, *drive.wheel_model());
  for (std::size_t k = 0; k < moments.size(); ++k)
    if (!rates || !rates->fill(moments[k])) from_poses(poses, moments, k, moments[k]);
  return moments;
}

}  // namespace roadbook
