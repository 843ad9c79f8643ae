#include "diagnosis/detector/person_filter.hpp"

#include <Eigen/LU>
#include <cmath>

namespace roadbook {

PersonFilter::PersonFilter(const Eigen::Vector2d& foot,
                           const Eigen::Matrix2d& R,
                           PersonMotion motion)
    : motion_(motion) {
  mean_.head<2>() = foot;
  covariance_.setZero();
  covariance_.topLeftCorner<2, 2>() = R;
  covariance_.diagonal().tail<2>().setConstant(motion.speed * motion.speed);
}

// Exact integral of the Ornstein-Uhlenbeck process over dt.
void PersonFilter::step(const PersonMotion& motion,
                        double dt_s,
                        Eigen::Matrix4d& transition,
                        Eigen::Matrix4d& noise) {
  const double T = motion.memory_s;
  const double keep = std::exp(-dt_s / T);
  const double run = T * (1.0 - keep);  // displacement by unit velocity
  const double v2 = motion.speed * motion.speed;
  const double vv = v2 * (1.0 - keep * keep);
  const double pv = v2 * T * (1.0 - keep) * (1.0 - keep);
  const double pp = v2 * (2.0 * T * dt_s - T * T * (3.0 - 4.0 * keep + keep * keep)) +
                    motion.shift * motion.shift * dt_s;
  transition.setIdentity();
  noise.setZero();
  for (int axis = 0; axis < 2; ++axis) {
    transition(axis, axis + 2) = run;
    transition(axis + 2, axis + 2) = keep;
    noise(axis, axis) = pp;
    noise(axis, axis + 2) = noise(axis + 2, axis) = pv;
    noise(axis + 2, axis + 2) = vv;
  }
}

void PersonFilter::predict(double dt_s) {
  Eigen::Matrix4d F;
  Eigen::Matrix4d Q;
  step(motion_, dt_s, F, Q);
  mean_ = F * mean_;
  covariance_ = F * covariance_ * F.transpose() + Q;
}

double PersonFilter::distance2(const Eigen::Vector2d& foot,
                               const Eigen::Matrix2d& R,
                               double& log_determinant) const {
  const Eigen::Vector2d d = foot - mean_.head<2>();
  const Eigen::Matrix2d S = covariance_.topLeftCorner<2, 2>() + R;
  log_determinant = std::log(S.determinant());
  return d.dot(S.inverse() * d);
}

void PersonFilter::update(const Eigen::Vector2d& foot, const Eigen::Matrix2d& R) {
  const Eigen::Matrix2d S = covariance_.topLeftCorner<2, 2>() + R;
  const Eigen::Matrix<double, 4, 2> gain = covariance_.leftCols<2>() * S.inverse();
  mean_ += gain * (foot - mean_.head<2>());
  covariance_ -= gain * S * gain.transpose();
  covariance_ = 0.5 * (covariance_ + covariance_.transpose()).eval();
}

std::vector<Eigen::Vector2d> smoothed_feet(const std::vector<PlacedFeet>& sightings,
                                           const PersonMotion& motion) {
  const std::size_t n = sightings.size();
  std::vector<Eigen::Vector4d> mean(n), before(n);
  std::vector<Eigen::Matrix4d> P(n), P_before(n), F(n);
  for (std::size_t i = 0; i < n; ++i) {
    const PlacedFeet& s = sightings[i];
    if (i == 0) {
      mean[0] << s.foot, 0.0, 0.0;
      P[0].setZero();
      P[0].topLeftCorner<2, 2>() = s.covariance;
      P[0].diagonal().tail<2>().setConstant(motion.speed * motion.speed);
      continue;
    }
    Eigen::Matrix4d Q;
    PersonFilter::step(motion, s.t_s - sightings[i - 1].t_s, F[i], Q);
    before[i] = F[i] * mean[i - 1];
    P_before[i] = F[i] * P[i - 1] * F[i].transpose() + Q;
    const Eigen::Matrix2d S = P_before[i].topLeftCorner<2, 2>() + s.covariance;
    const Eigen::Matrix<double, 4, 2> gain = P_before[i].leftCols<2>() * S.inverse();
    mean[i] = before[i] + gain * (s.foot - before[i].head<2>());
    P[i] = P_before[i] - gain * S * gain.transpose();
  }
  for (std::size_t i = n; i-- > 1;) {
    const Eigen::Matrix4d back = P[i - 1] * F[i].transpose() * P_before[i].inverse();
    mean[i - 1] += back * (mean[i] - before[i]);
  }
  std::vector<Eigen::Vector2d> feet;
  for (const Eigen::Vector4d& m : mean) feet.emplace_back(m.head<2>());
  return feet;
}

}  // namespace roadbook
