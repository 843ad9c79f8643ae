#include "diagnosis/inference/lasting_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "diagnosis/numerics/block_scatter.hpp"
#include "tests/diagnosis/regression_problem.hpp"

namespace roadbook {
namespace {

// Values whose autocorrelation falls by e in `time_s`, standard deviation 1.
Eigen::VectorXd lasting(const test::RegressionProblem& problem, Random& random, double time_s) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(problem.rows()));
  const double keep = std::exp(-problem.time(1) / time_s);
  double v = random.normal();
  for (double& value : values) {
    value = v;
    v = keep * v + std::sqrt(1.0 - keep * keep) * random.normal();
  }
  return values;
}

struct Share {
  double sure = 0.0;  // p-value of 0.001 at most
  double held = 0.0;  // true size within two standard errors
  double last = 0.0;  // errors are found to last
};

// Of 200 readings of 100 s with a slow cause of `size` in them and errors of standard deviation 3
// that last `time_s` (0: none) beside the white ones of 1.
Share share_of(double size, double time_s) {
  constexpr int kProblems = 200;
  Share share;
  for (int i = 0; i < kProblems; ++i) {
    test::RegressionProblem problem(static_cast<std::uint64_t>(i), 1000);
    Random random(7, "lasting", static_cast<std::uint64_t>(i));
    problem.add("a.slow", lasting(problem, random, 5.0));
    problem.hide(0, size);
    problem.add("error", lasting(problem, random, time_s > 0.0 ? time_s : 1.0));
    problem.hide(1, time_s > 0.0 ? 3.0 : 0.0);
    CauseModel model;
    accept(model, problem.project(model, {problem.candidates(model)[0]}).candidates[0]);
    problem.fit(model, 1);
    const auto white = without_autocorrelation(problem.project(model, {}), {0});
    if (!white) continue;
    share.last += 1.0 / kProblems;
    const SizeByBlocks found = size_by_blocks(model, *white, 0);
    share.sure += (found.p <= 0.001 ? 1.0 : 0.0) / kProblems;
    const double error = std::abs(model.accepted[0].size[0] - size);
    share.held += (error <= 2.0 * found.sigma ? 1.0 : 0.0) / kProblems;
  }
  return share;
}

TEST(LastingErrors, MakeNoCauseSureAndIntervalsHold) {
  for (const double time_s : {0.3, 1.0, 3.0, 10.0}) {
    const Share share = share_of(0.0, time_s);
    EXPECT_GE(share.last, 0.99) << time_s;
    EXPECT_LE(share.sure, 0.01) << time_s;
    EXPECT_GE(share.held, 0.9) << time_s;
  }
}

TEST(LastingErrors, LeaveALargeCauseSure) {
  for (const double time_s : {0.3, 1.0, 10.0}) EXPECT_GE(share_of(5.0, time_s).sure, 0.9) << time_s;
}

TEST(LastingErrors, AreNotFoundInWhiteOnes) { EXPECT_LE(share_of(0.5, 0.0).last, 0.005); }

// Twelve seconds of one row each, two errors of one sign after two of the other. By seconds the
// sum's square is 16 times their squares, by blocks of two 8 times, with 5 degrees of freedom:
// Student's t at sqrt(8 * 5 / 6), two-sided (by numerical integration).
TEST(BlockScatter, IsTheWorstTailOfF) {
  std::vector<BlockPart> parts;
  for (int i = 0; i < 12; ++i) parts.push_back({1.1 * i, i % 4 < 2 ? 1.0 : -1.0, 1.0});
  EXPECT_DOUBLE_EQ(squares_of_blocks(parts, 1.0), 12.0);
  EXPECT_DOUBLE_EQ(squares_of_blocks(parts, 2.0), 24.0);
  EXPECT_NEAR(p_by_block_scatter(std::sqrt(192.0), parts, 1), 0.0493131, 1e-6);
  parts.resize(6);  // no six blocks of two
  EXPECT_NEAR(p_by_block_scatter(std::sqrt(96.0), parts, 1), 0.0147254, 1e-6);
}

}  // namespace
}  // namespace roadbook
