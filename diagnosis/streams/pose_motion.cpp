#include "diagnosis/streams/pose_motion.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/median.hpp"

namespace roadbook {

PoseSmoother::PoseSmoother(const std::vector<PoseSample>& poses, double half_s)
    : poses_(poses), half_s_(half_s) {
  for (std::size_t i = 1; i < poses_.size(); ++i)
    poses_[i].heading =
        poses_[i - 1].heading +
        std::remainder(poses[i].heading - poses[i - 1].heading, 2.0 * std::numbers::pi);
}

std::optional<PoseMotion> PoseSmoother::at(double t_s) {
  if (poses_.empty() || t_s < poses_.front().t_s || t_s > poses_.back().t_s) return std::nullopt;
  if (first_ >= poses_.size() || poses_[first_].t_s > t_s - half_s_) first_ = 0;
  while (poses_[first_].t_s < t_s - half_s_) ++first_;
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d b = Eigen::Matrix3d::Zero();  // columns: x, y, heading
  bool before = false;
  bool after = false;
  for (std::size_t i = first_; i < poses_.size() && poses_[i].t_s <= t_s + half_s_; ++i) {
    const PoseSample& p = poses_[i];
    const double u = p.t_s - t_s;
    const Eigen::Vector3d v(1.0, u, 0.5 * u * u);
    G += v * v.transpose();
    b += v * Eigen::RowVector3d(p.x - poses_[first_].x, p.y - poses_[first_].y, p.heading);
    before = before || u <= 0.0;
    after = after || u >= 0.0;
  }
  if (!before || !after || !(G(0, 0) >= 5.0)) return std::nullopt;
  const Eigen::Matrix3d fit = G.ldlt().solve(b);
  PoseMotion m;
  m.x = poses_[first_].x + fit(0, 0);
  m.y = poses_[first_].y + fit(0, 1);
  m.heading = fit(0, 2);
  m.yaw_rate = fit(1, 2);
  const double c = std::cos(m.heading);
  const double s = std::sin(m.heading);
  m.speed = c * fit(1, 0) + s * fit(1, 1);
  m.acceleration = c * fit(2, 0) + s * fit(2, 1);
  m.lateral_acceleration = m.speed * m.yaw_rate;
  return m;
}

double half_window_of(const std::vector<PoseSample>& poses) {
  constexpr double kMost_s = 0.7;
  constexpr double kLeast_s = 0.25;
  constexpr double kMoved_m = 0.05;
  constexpr double kScatter_m = 0.02;  // pose noise that needs the widest window
  if (poses.size() < 10) return kMost_s;
  std::vector<double> intervals, of_x, of_y;
  for (std::size_t i = 1; i < poses.size(); ++i)
    intervals.push_back(poses[i].t_s - poses[i - 1].t_s);
  const double interval = median(intervals);
  for (std::size_t i = 3; i < poses.size(); ++i) {
    const auto third = [&](double PoseSample::*c) {
      return std::abs(poses[i].*c - 3.0 * poses[i - 1].*c + 3.0 * poses[i - 2].*c -
                      poses[i - 3].*c);
    };
    // A receiver may repeat the pose of a car at standstill.
    const bool moves =
        std::hypot(poses[i].x - poses[i - 3].x, poses[i].y - poses[i - 3].y) > kMoved_m;
    if (!moves || poses[i].t_s - poses[i - 3].t_s > 4.5 * interval) continue;
    of_x.push_back(third(&PoseSample::x));
    of_y.push_back(third(&PoseSample::y));
  }
  if (of_x.empty()) return kMost_s;
  // The median of |N(0, sigma)| is 0.6745 sigma; a third difference has 20 times the variance of a
  // pose.
  const double scatter =
      std::max(median(std::move(of_x)), median(std::move(of_y))) / 0.6745 / std::sqrt(20.0);
  const double half = kMost_s * std::pow(scatter / kScatter_m * std::sqrt(interval / 0.08), 0.4);
  return std::clamp(half, std::max(kLeast_s, std::min(3.0 * interval, kMost_s)), kMost_s);
}

}  // namespace roadbook
