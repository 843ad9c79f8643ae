#include "semantics/detector/question_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.hpp"
#include "semantics/detector/gp_classifier.hpp"

namespace roadbook {
namespace {

// Groups of similar things: f has variance 1, and correlation 0.95 within a group.
Eigen::MatrixXd groups(const std::vector<int>& sizes) {
  int n = 0;
  for (const int size : sizes) n += size;
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(n, n);
  int first = 0;
  for (const int size : sizes) {
    for (int i = first; i < first + size; ++i)
      for (int j = first; j < first + size; ++j)
        if (i != j) C(i, j) = 0.95;
    first += size;
  }
  return C;
}

TEST(QuestionChoice, OfEquallyUnsureThingsThoseThatManyAreLikeComeFirstAndEachKindOnce) {
  const auto chosen =
      most_telling(100.0 * groups({1, 6, 3}), Eigen::VectorXd::Constant(10, 0.45), 3);
  ASSERT_EQ(chosen.size(), 3U);
  EXPECT_TRUE(chosen[0] >= 1 && chosen[0] < 7) << chosen[0];
  EXPECT_GE(chosen[1], 7U);
  EXPECT_EQ(chosen[2], 0U);
}

TEST(QuestionChoice, HalfOfTheQuestionsAreAboutWhatWouldBeTakenForPositive) {
  Eigen::VectorXd probability = Eigen::VectorXd::Constant(40, 0.4);
  for (const int i : {3, 11, 17, 29, 33}) probability[i] = 0.9;
  const auto chosen = most_telling(Eigen::MatrixXd::Identity(40, 40), probability, 8);
  const auto positive = std::count_if(chosen.begin(), chosen.end(), [&](std::size_t i) {
    return probability[static_cast<Eigen::Index>(i)] > 0.5;
  });
  EXPECT_EQ(positive, 4);
}

TEST(QuestionChoice, AsksAboutEverythingOnceWhereThereIsLittle) {
  Eigen::VectorXd probability(3);
  probability << 0.0, 0.2, 1.0;
  auto chosen = most_telling(groups({3}), probability, 10);
  std::sort(chosen.begin(), chosen.end());
  EXPECT_EQ(chosen, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(most_telling(Eigen::MatrixXd(0, 0), Eigen::VectorXd(0), 10).empty());
}

// f is linear: at the point between two others, f is their mean. The variances alone therefore give
// the covariance of the two.
TEST(GpClassifier, CovarianceIsThatOfAStraightLineThroughItsVariances) {
  for (const int examples : {12, 80}) {  // fewer and more than features
    Random random(3, "covariance");
    Eigen::MatrixXd X(examples, 20);
    std::vector<int> labels;
    for (int i = 0; i < examples; ++i) {
      for (int j = 0; j < X.cols(); ++j) X(i, j) = random.normal();
      labels.push_back(X(i, 0) + 0.5 * random.normal() > 0.0 ? 1 : -1);
    }
    labels[0] = 1;
    labels[1] = -1;
    const GpClassifier classifier = GpClassifier::train(X, labels);
    const Eigen::MatrixXd points = 0.7 * X.topRows(6);
    const Eigen::MatrixXd C = classifier.covariance(points);
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = 0; j < 6; ++j) {
        const Eigen::VectorXd middle = 0.5 * (points.row(i) + points.row(j));
        const double expected = 2.0 * classifier.predict(middle).variance -
                                0.5 * (classifier.predict(points.row(i)).variance +
                                       classifier.predict(points.row(j)).variance);
        EXPECT_NEAR(C(i, j), expected, 1e-8 * C.diagonal().maxCoeff()) << examples;
      }
  }
}

}  // namespace
}  // namespace roadbook
