#include "semantics/detector/search_prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "semantics/detector/gp_classifier.hpp"

namespace roadbook {
namespace {

double probability_of(double logit) { return 1.0 / (1.0 + std::exp(-logit)); }

// Hypotheses with logits of all sizes. The share of true ones is smaller than their probabilities
// predict.
std::vector<SearchAnswer> answers(std::size_t count, double true_shift) {
  Random random(5, "answers");
  std::vector<SearchAnswer> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    const double logit = 2.0 * random.normal();
    drawn.push_back({logit, random.uniform(0.0, 1.0) < probability_of(logit + true_shift)});
  }
  return drawn;
}

TEST(SearchPrior, TheShiftIsThatWithWhichTheAnswersWereDrawn) {
  for (const double shift : {-1.5, 0.0, 0.8}) {
    EXPECT_NEAR(prior_shift(answers(20000, shift)), shift, 0.08) << shift;
  }
}

// Five hundred windows of a street without pedestrians say nothing about a street with pedestrians.
TEST(SearchPrior, AnswersOfOneKindAloneTellNothing) {
  EXPECT_EQ(prior_shift({}), 0.0);
  EXPECT_EQ(prior_shift(std::vector<SearchAnswer>(500, {0.0, false})), 0.0);
  EXPECT_EQ(prior_shift(std::vector<SearchAnswer>(500, {0.0, true})), 0.0);
}

// By hand: one right and six wrong answers at logit 0 give the slope 1 - 7 p(s). The prior gives -s
// times a quarter, times ten because there is only one right answer. With fourteen times as many
// answers, the prior gives -s times a quarter.
TEST(SearchPrior, FewOfOneKindTellLittle) {
  for (const std::size_t right : {std::size_t{1}, std::size_t{5}, std::size_t{14}}) {
    std::vector<SearchAnswer> given(right, {0.0, true});
    given.resize(7 * right, {0.0, false});
    const auto count = static_cast<double>(right);
    const double shift = prior_shift(given);
    const double quarters = std::max(1.0, 10.0 / count);
    EXPECT_NEAR(count * (1.0 - 7.0 * probability_of(shift)), 0.25 * quarters * shift, 1e-8);
    EXPECT_GT(shift, -std::log(6.0));
  }
}

TEST(SearchPrior, WhatTheFirstRoundsSaidDoesNotCount) {
  const auto later = answers(400, -1.0);
  std::vector<SearchAnswer> all(400, {5.0, false});
  all.insert(all.end(), later.begin(), later.end());
  auto twice = later;
  twice.insert(twice.end(), later.begin(), later.end());
  EXPECT_NEAR(prior_shift(all), prior_shift(twice), 1e-9);
}

TEST(SearchPrior, OfTwoSourcesNeitherIsTheOlder) {
  const auto sure = answers(4000, 1.0);
  const auto doubtful = answers(4000, -1.0);
  const std::vector<std::vector<SearchAnswer>> sources{sure, doubtful};
  EXPECT_NEAR(prior_shift_of(sources), 0.0, 0.1);
}

TEST(SearchPrior, AShiftedClassifierSaysTheShiftedLogitAndFindsTheSameOrder) {
  Random random(7, "shifted");
  Eigen::MatrixXd X(40, 6);
  std::vector<int> labels;
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    for (Eigen::Index j = 0; j < X.cols(); ++j) X(i, j) = random.normal();
    labels.push_back(X(i, 0) > 0.0 ? 1 : -1);
  }
  GpClassifierOptions options;
  options.calibrate = true;
  GpClassifier classifier = GpClassifier::train(X, labels, options);
  const GpPrediction before = classifier.predict(X.row(3));
  classifier.set_shift(-1.2);
  const GpPrediction after = classifier.predict(X.row(3));
  EXPECT_NEAR(logit_of(after.probability), logit_of(before.probability) - 1.2, 1e-9);
  classifier.set_shift(100.0);
  EXPECT_LT(classifier.predict(X.row(3)).probability, 1.0) << "only a person is certain";
  EXPECT_EQ(after.mean, before.mean);
  EXPECT_EQ(after.variance, before.variance);
}

// For n outcomes with probability one half, the error is |N(0, n / 4)| / n. Its mean is sqrt(1 / (2
// pi n)). 95 % of the errors are below 1.96 / (2 sqrt(n)).
TEST(CalibrationError, ByChanceAloneItIsThatOfCoins) {
  const std::vector<std::pair<double, bool>> coins(400, {0.5, false});
  const ChanceOfCalibration chance = chance_of_calibration(coins, 3);
  EXPECT_NEAR(chance.mean, 0.01995, 0.002);
  EXPECT_NEAR(chance.most, 0.049, 0.004);
  const std::vector<std::pair<double, bool>> sure(400, {1.0, true});
  EXPECT_EQ(chance_of_calibration(sure, 3).most, 0.0);
}

}  // namespace
}  // namespace roadbook
