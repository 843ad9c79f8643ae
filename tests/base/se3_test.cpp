#include "base/se3.hpp"

#include <gtest/gtest.h>

#include <unsupported/Eigen/MatrixFunctions>

#include "base/random.hpp"

namespace roadbook {
namespace {

Vector6d random_twist(Random& random, double scale) {
  Vector6d xi;
  for (auto& value : xi) value = scale * random.normal();
  return xi;
}

TEST(Se3, ExponentialIsTheMatrixExponential) {
  Random random(1);
  for (const double scale : {1e-9, 1e-4, 0.1, 1.0}) {
    const Vector6d xi = random_twist(random, scale);
    Eigen::Matrix4d hat = Eigen::Matrix4d::Zero();
    hat.topLeftCorner<3, 3>() = skew<double>(xi.tail<3>());
    hat.topRightCorner<3, 1>() = xi.head<3>();
    const Eigen::Matrix4d expected = hat.exp();
    EXPECT_LT((se3_exp(xi).matrix() - expected).norm(), 1e-12);
  }
}

TEST(Se3, LogarithmUndoesExponentialUpToHalfATurn) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    Vector6d xi = random_twist(random, 1.0);
    xi.tail<3>() *= random.uniform(0.0, 3.14) / xi.tail<3>().norm();
    EXPECT_LT((se3_log(se3_exp(xi)) - xi).norm(), 1e-8);
  }
}

TEST(Se3, AdjointMovesAPerturbationAcross) {
  Random random(3);
  const Eigen::Isometry3d T = se3_exp(random_twist(random, 1.0));
  const Vector6d xi = random_twist(random, 0.3);
  EXPECT_LT(((T * se3_exp(xi)).matrix() - (se3_exp(se3_adjoint(T) * xi) * T).matrix()).norm(),
            1e-12);
}

TEST(Se3, RightJacobianIsTheDerivativeOfTheExponential) {
  Random random(4);
  const Eigen::Vector3d phi = random_twist(random, 0.7).head<3>();
  const Eigen::Matrix3d J = so3_right_jacobian(phi);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = 1e-6 * Eigen::Vector3d::Unit(k);
    const Eigen::Vector3d numeric = so3_log(so3_exp(phi - d).transpose() * so3_exp(phi + d)) / 2e-6;
    EXPECT_LT((J.col(k) - numeric).norm(), 1e-8);
  }
  EXPECT_LT((J * so3_right_jacobian_inverse(phi) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Se3, ComposedCovarianceAgreesWithSamples) {
  Random random(5);
  const Eigen::Isometry3d T_a_b = se3_exp(random_twist(random, 1.0));
  const Eigen::Isometry3d T_b_c = se3_exp(random_twist(random, 1.0));
  const Matrix6d cov_a_b =
      (Vector6d() << 1e-4, 2e-4, 3e-4, 1e-5, 2e-5, 3e-5).finished().asDiagonal();
  const Matrix6d cov_b_c = 0.5 * cov_a_b;
  const Eigen::Isometry3d inverse = (T_a_b * T_b_c).inverse();
  Matrix6d sampled = Matrix6d::Zero();
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    Vector6d a;
    Vector6d b;
    for (int k = 0; k < 6; ++k) {
      a[k] = random.normal(0.0, std::sqrt(cov_a_b(k, k)));
      b[k] = random.normal(0.0, std::sqrt(cov_b_c(k, k)));
    }
    const Vector6d e = se3_log(inverse * T_a_b * se3_exp(a) * T_b_c * se3_exp(b));
    sampled += e * e.transpose() / kSamples;
  }
  const Matrix6d predicted = compose_covariance(cov_a_b, T_b_c, cov_b_c);
  // 20,000 samples know a variance to 1 % (one sigma).
  EXPECT_LT((sampled - predicted).norm(), 0.04 * predicted.norm());
}

TEST(Se3, AnglesWrapIntoTheHalfOpenTurn) {
  EXPECT_NEAR(wrap_angle(7.0), 7.0 - 2.0 * M_PI, 1e-12);
  EXPECT_NEAR(wrap_angle(-M_PI), M_PI, 1e-12);
}

}  // namespace
}  // namespace roadbook
