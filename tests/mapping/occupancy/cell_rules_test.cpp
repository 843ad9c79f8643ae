#include "mapping/occupancy/cell_rules.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

// The table of document 001, row by row: the cell's state, then the reading.
TEST(CellRules, NaiveUpdateIsTheTableOfTheDocument) {
  constexpr std::array<double, 3> kStates{0.0, 0.5, 1.0};
  constexpr std::array<std::array<double, 3>, 3> kTable{
      {{0.0, 0.0, 0.0}, {0.0, 0.5, 1.0}, {0.0, 1.0, 1.0}}};
  for (std::size_t cell = 0; cell < 3; ++cell)
    for (std::size_t reading = 0; reading < 3; ++reading)
      EXPECT_EQ(naive_update(kStates[cell], kStates[reading]), kTable[cell][reading])
          << kStates[cell] << ", " << kStates[reading];
}

// 10,000 sequences of 30 readings: the three forms of the filter are one filter. Log odds stay
// within 7, because a probability closer to 1 than 1e-4 has lost the digits that the comparison
// needs.
TEST(CellRules, LogOddsAndRatioAreTheBayesFilter) {
  Random random(3);
  for (int sequence = 0; sequence < 10000; ++sequence) {
    const double prior = random.uniform(0.02, 0.6);
    double p = prior, ratio = prior / (1.0 - prior), l = log_odds(prior);
    for (int i = 0; i < 30; ++i) {
      double change = random.uniform(-2.0, 2.0);
      if (std::abs(l + change) > 7.0) change = -change;
      const double inverse = probability_of(log_odds(prior) + change);
      p = bayes_update(p, inverse, prior);
      ratio = ratio_update(ratio, inverse, prior);
      l = log_odds_update(l, inverse, prior);
    }
    ASSERT_NEAR(probability_of(l), p, 1e-12);
    ASSERT_NEAR(ratio / (1.0 + ratio), p, 1e-12);
  }
}

TEST(CellRules, ProbabilitiesNearZeroKeepTheirDigits) {
  for (const double l : {-600.0, -40.0, -1e-9, 0.0, 3.0})
    EXPECT_NEAR(log_odds(probability_of(l)), l, 1e-12 * std::max(1.0, std::abs(l)));
  EXPECT_EQ(probability_of(800.0), 1.0);
  EXPECT_EQ(probability_of(-800.0), 0.0);
}

}  // namespace
}  // namespace roadbook
