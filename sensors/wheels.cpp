#include "sensors/wheels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roadbook {
namespace {

struct Angles {
  double left;
  double right;
};

// Readings interpolated linearly; the caller has made sure that t lies within the stream.
Angles angles_at(const std::vector<WheelReading>& readings, std::size_t after, std::int64_t t_ns) {
  const WheelReading& b = readings[after];
  if (after == 0 || b.t_ns == t_ns) return {b.left_angle_rad, b.right_angle_rad};
  const WheelReading& a = readings[after - 1];
  const double w = static_cast<double>(t_ns - a.t_ns) / static_cast<double>(b.t_ns - a.t_ns);
  return {a.left_angle_rad + w * (b.left_angle_rad - a.left_angle_rad),
          a.right_angle_rad + w * (b.right_angle_rad - a.right_angle_rad)};
}

// One arc of constant curvature: motion, noise and how both move the covariance on.
void add_arc(const WheelModel& model, const Angles& from, const Angles& to, PlanarMotion& sum) {
  const Eigen::Vector2d step =
      wheel_increment<double>(to.left - from.left, to.right - from.right, model.radius_left_m,
                              model.radius_right_m, model.track_width_m);
  const double d = step.x();
  const double turn = step.y();
  // Chord of the arc: sin(h)/h and (1 - cos(h))/h by half-angles, stable for small turns.
  const double half = 0.5 * turn;
  const double sinc = std::abs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const double direction = sum.motion.z() + half;
  const double c = std::cos(direction);
  const double s = std::sin(direction);
  const double dx = d * sinc * c;
  const double dy = d * sinc * s;

  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -dy;
  F(1, 2) = dx;
  const double length = std::abs(d);
  Eigen::Matrix3d G;  // by distance, lateral slip, heading
  G << c, -s, -0.5 * dy, s, c, 0.5 * dx, 0.0, 0.0, 1.0;
  const Eigen::Vector3d variance =
      length * Eigen::Vector3d(model.sigma_distance_per_sqrt_m, model.sigma_lateral_per_sqrt_m,
                               model.sigma_heading_per_sqrt_m)
                   .cwiseAbs2();
  sum.covariance = F * sum.covariance * F.transpose() + G * variance.asDiagonal() * G.transpose();
  sum.motion += Eigen::Vector3d(dx, dy, turn);
  sum.distance_m += length;
}

// The readings at both ends are off by the encoder's noise; those between cancel.
void add_reading_noise(const WheelModel& model, PlanarMotion& sum) {
  const double r = 0.5 * (model.radius_left_m + model.radius_right_m);
  const double sigma2 = 2.0 * model.sigma_angle_rad * model.sigma_angle_rad;  // two ends
  const double along = 0.5 * r * r * sigma2;                                  // mean of two wheels
  const double turning = 2.0 * r * r * sigma2 / (model.track_width_m * model.track_width_m);
  const double c = std::cos(0.5 * sum.motion.z());
  const double s = std::sin(0.5 * sum.motion.z());
  const Eigen::Vector3d by_distance(c, s, 0.0);
  const Eigen::Vector3d by_turn(-0.5 * sum.motion.y(), 0.5 * sum.motion.x(), 1.0);
  sum.covariance +=
      along * by_distance * by_distance.transpose() + turning * by_turn * by_turn.transpose();
}

}  // namespace

WheelOdometry::WheelOdometry(const WheelModel& model, std::vector<WheelReading> readings)
    : model_(model), readings_(std::move(readings)) {
  const auto offset_ns = static_cast<std::int64_t>(std::llround(model.time_offset_s * 1e9));
  for (auto& reading : readings_) reading.t_ns += offset_ns;
}

void WheelOdometry::distrust(std::int64_t t_a_ns, std::int64_t t_b_ns) {
  distrusted_.emplace_back(t_a_ns, t_b_ns);
}

std::optional<PlanarMotion> WheelOdometry::between(std::int64_t t_a_ns,
                                                   std::int64_t t_b_ns,
                                                   std::int64_t max_gap_ns) const {
  if (readings_.empty() || t_b_ns < t_a_ns || t_a_ns < readings_.front().t_ns ||
      t_b_ns > readings_.back().t_ns)
    return std::nullopt;
  for (const auto& [begin, end] : distrusted_)
    if (t_a_ns < end && begin < t_b_ns) return std::nullopt;
  const auto not_before = [&](std::int64_t t) {
    return static_cast<std::size_t>(
        std::lower_bound(readings_.begin(), readings_.end(), t,
                         [](const WheelReading& r, std::int64_t time) { return r.t_ns < time; }) -
        readings_.begin());
  };
  const std::size_t first = not_before(t_a_ns);
  const std::size_t last = not_before(t_b_ns);
  for (std::size_t i = std::max<std::size_t>(first, 1); i <= last; ++i)
    if (readings_[i].t_ns - readings_[i - 1].t_ns > max_gap_ns && readings_[i].t_ns > t_a_ns)
      return std::nullopt;
  PlanarMotion sum;
  Angles angles = angles_at(readings_, first, t_a_ns);
  double net = 0.0;
  const auto advance = [&](const Angles& next) {
    net += next.left - angles.left + next.right - angles.right;
    add_arc(model_, angles, next, sum);
    angles = next;
  };
  for (std::size_t i = first; i < last; ++i)
    advance({readings_[i].left_angle_rad, readings_[i].right_angle_rad});
  advance(angles_at(readings_, last, t_b_ns));
  add_reading_noise(model_, sum);
  sum.reversing = net < 0.0;
  return sum;
}

}  // namespace roadbook
