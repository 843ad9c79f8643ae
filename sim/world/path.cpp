#include "sim/world/path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/se3.hpp"

namespace roadbook {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Appends the arc that rounds the corner at `corner` between `before` and `after`.
void add_rounded(const Eigen::Vector2d& before,
                 const Eigen::Vector2d& corner,
                 const Eigen::Vector2d& after,
                 double radius_m,
                 Points& out) {
  const Eigen::Vector2d in = (corner - before).normalized();
  const Eigen::Vector2d leave = (after - corner).normalized();
  const double turn = std::atan2(in.x() * leave.y() - in.y() * leave.x(), in.dot(leave));
  if (std::abs(turn) < 1e-6) {
    out.push_back(corner);
    return;
  }
  const double half_leg = 0.5 * std::min((corner - before).norm(), (after - corner).norm());
  const double tangent = std::min(radius_m * std::tan(0.5 * std::abs(turn)), half_leg);
  const double radius = tangent / std::tan(0.5 * std::abs(turn));
  const Eigen::Vector2d start = corner - tangent * in;
  const double side = turn > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d centre = start + side * radius * Eigen::Vector2d(-in.y(), in.x());
  const int steps = std::max(2, static_cast<int>(std::ceil(radius * std::abs(turn) / 0.02)));
  for (int i = 0; i <= steps; ++i) {
    const double a = turn * i / steps;
    const Eigen::Vector2d arm = start - centre;
    out.push_back(centre + Eigen::Vector2d(std::cos(a) * arm.x() - std::sin(a) * arm.y(),
                                           std::sin(a) * arm.x() + std::cos(a) * arm.y()));
  }
}

/// The polyline with points at equal distances of about `step`.
Points resampled(const Points& line, double step, double* exact_step) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < line.size(); ++i)
    along.push_back(along.back() + (line[i] - line[i - 1]).norm());
  const auto count = static_cast<std::size_t>(std::max(1.0, std::round(along.back() / step)));
  *exact_step = along.back() / static_cast<double>(count);
  Points result;
  std::size_t i = 1;
  for (std::size_t k = 0; k <= count; ++k) {
    const double s = std::min(along.back(), static_cast<double>(k) * *exact_step);
    while (i + 1 < line.size() && along[i] < s) ++i;
    const double leg = along[i] - along[i - 1];
    const double f = leg > 0.0 ? (s - along[i - 1]) / leg : 0.0;
    result.push_back(line[i - 1] + f * (line[i] - line[i - 1]));
  }
  return result;
}

}  // namespace

DrivingLine::DrivingLine(const Points& corners, double radius_m, bool closed) : closed_(closed) {
  if (corners.size() < 2) throw std::invalid_argument("a driving line needs two points");
  Points line;
  const std::size_t n = corners.size();
  if (closed) {
    // Begins in the middle of the first leg, so that the seam is not in a corner.
    const Eigen::Vector2d begin = 0.5 * (corners[0] + corners[1]);
    line.push_back(begin);
    for (std::size_t k = 1; k <= n; ++k)
      add_rounded(corners[k - 1], corners[k % n], corners[(k + 1) % n], radius_m, line);
    line.push_back(begin);
  } else {
    line.push_back(corners.front());
    for (std::size_t k = 1; k + 1 < n; ++k)
      add_rounded(corners[k - 1], corners[k], corners[k + 1], radius_m, line);
    line.push_back(corners.back());
  }
  points_ = resampled(line, step_m_, &step_m_);
  length_m_ = step_m_ * static_cast<double>(points_.size() - 1);
}

double DrivingLine::wrapped(double s) const {
  if (!closed_) return s;
  const double r = std::fmod(s, length_m_);
  return r < 0.0 ? r + length_m_ : r;
}

Eigen::Vector2d DrivingLine::at(double s) const {
  const double u = wrapped(s) / step_m_;
  const double last = static_cast<double>(points_.size() - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(u), 0.0, last));
  return points_[i] + (u - static_cast<double>(i)) * (points_[i + 1] - points_[i]);
}

double DrivingLine::heading(double s) const {
  const Eigen::Vector2d d = at(s + 0.5 * step_m_) - at(s - 0.5 * step_m_);
  return std::atan2(d.y(), d.x());
}

double DrivingLine::curvature(double s) const {
  constexpr double kHalf = 0.4;
  return wrap_angle(heading(s + kHalf) - heading(s - kHalf)) / (2.0 * kHalf);
}

double DrivingLine::nearest(const Eigen::Vector2d& p, double near_s, double window_m) const {
  double best = near_s;
  double best_distance = (at(near_s) - p).squaredNorm();
  for (double s = near_s - window_m; s <= near_s + window_m; s += step_m_) {
    const double distance = (at(s) - p).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best = s;
    }
  }
  return best;
}

std::vector<Eigen::Vector2d> DrivingLine::sampled(double step_m) const {
  double exact = 0.0;
  return resampled(points_, step_m, &exact);
}

DrivingLine route_line(const Scenario& scenario, const std::vector<std::string>& lanes) {
  Points corners;
  for (const auto& name : lanes) {
    const LaneSpec& lane = scenario.lane(name);
    for (const auto& point : lane.points)
      if (corners.empty() || (corners.back() - point).norm() > 1e-3) corners.push_back(point);
  }
  bool closed = lanes.size() == 1 && scenario.lane(lanes.front()).closed;
  if (corners.size() > 2 && (corners.front() - corners.back()).norm() < 1e-3) {
    corners.pop_back();
    closed = true;
  }
  return {corners, scenario.vehicle.turn_radius_m, closed};
}

}  // namespace roadbook
