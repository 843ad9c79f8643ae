#include "diagnosis/streams/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {

Trajectory::Trajectory(double start_s, double step_s, std::size_t knots)
    : x(knots),
      y(knots),
      heading(knots),
      speed(knots),
      yaw_rate(knots),
      start_s_(start_s),
      step_s_(step_s),
      distance_(knots),
      turned_(knots) {
  ROADBOOK_ASSERT(knots >= 2 && step_s > 0.0);
}

double Trajectory::knot_s(std::size_t j) const {
  return start_s_ + step_s_ * static_cast<double>(j);
}

std::size_t Trajectory::interval(double t_s) const {
  const double u = std::clamp((t_s - start_s_) / step_s_, 0.0, static_cast<double>(knots() - 2));
  return static_cast<std::size_t>(u);
}

MotionState Trajectory::at(double t_s) const {
  const std::size_t j = interval(t_s);
  return after(j, t_s - knot_s(j));
}

MotionState Trajectory::rates_at(double t_s) const {
  const std::size_t j = interval(t_s);
  return rates_after(j, t_s - knot_s(j));
}

MotionState Trajectory::rates_after(std::size_t j, double tau_s) const {
  MotionState s;
  const double a = (speed[j + 1] - speed[j]) / step_s_;
  const double alpha = (yaw_rate[j + 1] - yaw_rate[j]) / step_s_;
  s.speed = speed[j] + a * tau_s;
  s.yaw_rate = yaw_rate[j] + alpha * tau_s;
  s.acceleration = a;
  const double turned = tau_s * (yaw_rate[j] + 0.5 * alpha * tau_s);
  s.heading = heading[j] + turned;
  s.turned = turned_[j] + turned;
  s.distance_m = distance_[j] + tau_s * (speed[j] + 0.5 * a * tau_s);
  return s;
}

MotionState Trajectory::after(std::size_t j, double tau_s) const {
  MotionState s = rates_after(j, tau_s);
  const double a = s.acceleration;
  const double alpha = (yaw_rate[j + 1] - yaw_rate[j]) / step_s_;
  // Three-point Gauss quadrature: exact to the sixth power of the turn within one step.
  constexpr std::array kNode{0.1127016653792583, 0.5, 0.8872983346207417};
  constexpr std::array kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  s.x = x[j];
  s.y = y[j];
  for (std::size_t i = 0; i < kNode.size(); ++i) {
    const double tau = kNode[i] * tau_s;
    const double psi = heading[j] + tau * (yaw_rate[j] + 0.5 * alpha * tau);
    const double step = kWeight[i] * tau_s * (speed[j] + a * tau);
    s.x += step * std::cos(psi);
    s.y += step * std::sin(psi);
  }
  return s;
}

void Trajectory::integrate() {
  for (std::size_t j = 0; j + 1 < knots(); ++j) {
    distance_[j + 1] = distance_[j] + 0.5 * step_s_ * (speed[j] + speed[j + 1]);
    turned_[j + 1] = turned_[j] + 0.5 * step_s_ * (yaw_rate[j] + yaw_rate[j + 1]);
  }
}

namespace {

// Value at the middle of the least-squares cubic through 2 m + 1 equidistant samples.
double savitzky_golay(const std::vector<double>& values, std::size_t j, std::size_t m) {
  const auto n = static_cast<double>(m);
  const double norm = (2.0 * n - 1.0) * (2.0 * n + 1.0) * (2.0 * n + 3.0);
  double sum = 0.0;
  for (std::size_t i = 0; i <= 2 * m; ++i) {
    const double k = static_cast<double>(i) - n;
    const double weight = 3.0 * (3.0 * n * n + 3.0 * n - 1.0 - 5.0 * k * k) / norm;
    sum += weight * values[j + i - m];
  }
  return sum;
}

}  // namespace

Trajectory smoothed(const Trajectory& trajectory, std::size_t half) {
  Trajectory smooth = trajectory;
  const std::size_t last = trajectory.knots() - 1;
  for (std::size_t j = 0; j <= last; ++j) {
    const std::size_t m = std::min({half, j, last - j});
    if (m < 2) continue;
    smooth.speed[j] = savitzky_golay(trajectory.speed, j, m);
    smooth.yaw_rate[j] = savitzky_golay(trajectory.yaw_rate, j, m);
  }
  smooth.integrate();
  return smooth;
}

}  // namespace roadbook
