#include "diagnosis/inference/score_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "tests/diagnosis/regression_problem.hpp"

namespace roadbook {
namespace {

// The same rows, those of every seventh reading first, then those after them, ...: as of seven
// people, one after the other.
Projection by_people(const Projection& p) {
  constexpr std::size_t kPeople = 7;
  Projection other = p;
  Innovations& in = other.innovations;
  in.of.clear();
  in.values.clear();
  for (std::size_t person = 0; person < kPeople; ++person)
    for (std::size_t i = person; i < p.innovations.of.size(); i += kPeople) {
      const double* row = p.innovations.row(i);
      in.of.push_back(p.innovations.of[i]);
      in.values.insert(in.values.end(), row, row + in.sides);
    }
  return other;
}

TEST(ScoreTable, TheScatterOfSecondsIsThatOfTimeInWhateverOrderRowsStand) {
  test::RegressionProblem problem(31, 1000);
  problem.add("a.first", problem.draw());
  problem.add("a.second", problem.draw());
  problem.hide(0, 0.3);
  problem.hide(1, 0.2);
  CauseModel model;
  accept(model, problem.project(model, problem.candidates(model)).candidates[0]);
  problem.fit(model, 1);
  const Projection rows = problem.project(model, {problem.candidates(model)[1]});
  const ScoreTable by_time(model, rows);
  const ScoreTable other(model, by_people(rows));
  const double robust = by_time.robust_p(0);
  EXPECT_LT(robust, 0.01);
  EXPECT_NEAR(other.robust_p(0), robust, 1e-6 * robust);
  EXPECT_NEAR(other.block_scatter(0), by_time.block_scatter(0), 1e-9);
}

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

// Share of 200 problems of 100 s in which a slow candidate of `size` has a robust p-value of 0.001.
double share_admitted(double size, double error, double error_time_s) {
  int admitted = 0;
  constexpr int kProblems = 200;
  for (int i = 0; i < kProblems; ++i) {
    test::RegressionProblem problem(static_cast<std::uint64_t>(i), 1000);
    Random random(7, "lasting", static_cast<std::uint64_t>(i));
    problem.add("a.first", lasting(problem, random, 5.0));
    problem.hide(0, size);
    problem.add("error", lasting(problem, random, error_time_s));
    problem.hide(1, error);
    const CauseModel model;
    const ScoreTable table(model, problem.project(model, {problem.candidates(model)[0]}));
    admitted += table.robust_p(0) <= 0.001 ? 1 : 0;
  }
  return static_cast<double>(admitted) / kProblems;
}

TEST(ScoreTable, ErrorsThatLastMakeNoEffectSure) {
  for (const double time_s : {0.3, 1.0, 3.0}) EXPECT_LE(share_admitted(0.0, 2.0, time_s), 0.01);
  EXPECT_LE(share_admitted(0.0, 2.0, 10.0), 0.03);
  // Without them, ten standard errors are enough.
  EXPECT_GE(share_admitted(10.0 / std::sqrt(1000.0), 0.0, 1.0), 0.95);
}

}  // namespace
}  // namespace roadbook
