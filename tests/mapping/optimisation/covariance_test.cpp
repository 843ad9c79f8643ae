#include "mapping/optimisation/covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "mapping/optimisation/block_cholesky.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

namespace roadbook {
namespace {

TEST(Covariance, BlockCholeskySolvesAndInvertsAsDenseAlgebraDoes) {
  Random random(1, "block cholesky");
  constexpr int n = 80;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i + 1 < n; ++i) pairs.emplace_back(i, i + 1);
  for (int k = 0; k < 40; ++k)
    pairs.emplace_back(static_cast<int>(random.below(n)), static_cast<int>(random.below(n)));
  std::erase_if(pairs, [](const auto& p) { return p.first == p.second; });
  BlockCholesky sparse(n, pairs);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(6 * n, 6 * n);
  const auto add = [&](int a, int b, const Matrix6d& m) {
    sparse.add(a, b, m);
    dense.block<6, 6>(6 * a, 6 * b) += m;
    if (a != b) dense.block<6, 6>(6 * b, 6 * a) += m.transpose();
  };
  for (const auto& [a, b] : pairs) {
    Matrix6d m;
    for (int i = 0; i < 36; ++i) m(i) = random.normal();
    add(a, b, m);
  }
  for (int i = 0; i < n; ++i)
    add(i, i, 100.0 * Matrix6d::Identity());  // dominant: positive definite
  Eigen::VectorXd b(6 * n);
  for (auto& value : b) value = random.normal();
  BlockCholesky by_one = sparse;
  ASSERT_TRUE(sparse.factor(2));
  ASSERT_TRUE(by_one.factor(1));
  Eigen::VectorXd x = b;
  sparse.solve(x);
  EXPECT_LT((dense * x - b).norm(), 1e-10 * b.norm());
  const Eigen::MatrixXd inverse = dense.inverse();
  const std::vector<Matrix6d> diagonal = sparse.inverse_diagonal(2);
  for (int i = 0; i < n; ++i)
    EXPECT_LT((diagonal[static_cast<std::size_t>(i)] - inverse.block<6, 6>(6 * i, 6 * i)).norm(),
              1e-10 * inverse.norm());
  for (const auto& [a, c] : pairs) {
    bool transposed = false;
    const Matrix6d stored = sparse.block(a, c, transposed);
    EXPECT_LT(
        ((transposed ? Matrix6d(stored.transpose()) : stored) - inverse.block<6, 6>(6 * a, 6 * c))
            .norm(),
        1e-10 * inverse.norm());
  }
  EXPECT_EQ(by_one.inverse_diagonal(1), diagonal);
}

// Normalised squared errors of the last pose over many draws of the noise: chi-square with 6
// degrees of freedom each, so the mean of n lies within 6 +- 3.3 sqrt(12 / n) (99.9 %).
TEST(Covariance, CoversTheErrorsOfPosesOverManyDraws) {
  constexpr int kRuns = 40;
  double sum = 0.0;
  double count = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    test::SyntheticBundle s =
        test::synthetic_bundle({.length_m = 20.0, .point_count = 40, .ground_share = 0.0},
                               100 + static_cast<std::uint64_t>(run));
    BundleOptions options;
    options.loss = RobustLoss::kNone;
    options.outlier_rounds = 0;
    options.num_threads = 1;
    const BundleResult result = bundle_adjust(s.problem, options);
    ASSERT_TRUE(result.usable);
    const BundleCovariance covariance = bundle_covariance(s.problem, result.inlier, options);
    ASSERT_TRUE(covariance.usable) << covariance.message;
    EXPECT_EQ(covariance.poses[0], Matrix6d::Zero());
    const std::size_t i = s.poses.size() / 2;
    const Vector6d e = se3_log(s.problem.poses[i].T_map_vehicle.inverse() * s.poses[i]);
    sum += e.dot(covariance.poses[i].ldlt().solve(e));
    count += 1.0;
  }
  std::printf("mean NEES %.2f\n", sum / count);
  EXPECT_NEAR(sum / count, 6.0, 3.3 * std::sqrt(12.0 / count));
}

}  // namespace
}  // namespace roadbook
