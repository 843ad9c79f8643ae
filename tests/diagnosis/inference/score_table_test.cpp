#include "diagnosis/inference/score_table.hpp"

#include <gtest/gtest.h>

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
  const double robust = by_time.robust_statistic(0);
  EXPECT_GT(robust, 10.0);
  EXPECT_NEAR(other.robust_statistic(0), robust, 1e-9 * robust);
  EXPECT_NEAR(other.block_scatter(0), by_time.block_scatter(0), 1e-9);
}

}  // namespace
}  // namespace roadbook
