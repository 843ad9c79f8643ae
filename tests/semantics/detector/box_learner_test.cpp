#include "semantics/detector/box_learner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/semantics/outlined_boxes.hpp"

namespace roadbook {
namespace {

using test::outlined_boxes;
using test::OutlinedBoxes;

BoxLearnerOptions options_of(QuestionPolicy questions, bool calibrate = true) {
  BoxLearnerOptions options;
  options.questions = questions;
  options.classifier.calibrate = calibrate;
  options.search.orientations = 12;
  options.search.scales = {1.0};
  options.search.hypotheses = 60;
  return options;
}

void teach(const OutlinedBoxes& lot, int count, BoxLearner& learner) {
  for (int i = 0; i < count; ++i) learner.add_positive(lot.spaces[static_cast<std::size_t>(i)]);
}

bool same_boxes(const std::vector<OrientedBox>& a, const std::vector<OrientedBox>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.centre == q.centre && p.heading == q.heading && p.length_m == q.length_m;
  });
}

std::size_t negatives_of(const BoxExamples& examples) {
  return static_cast<std::size_t>(std::count(examples.labels.begin(), examples.labels.end(), -1));
}

// The learner selects found boxes and questions by the model's own probability: the integral of the
// logistic function over its Gaussian. The answers do not change this probability.
TEST(BoxLearner, AnswersMoveWhatIsSaidAndNeitherWhatIsFoundNorWhatIsAsked) {
  const OutlinedBoxes lot = outlined_boxes(30, 11);
  for (const auto policy : {QuestionPolicy::kTelling, QuestionPolicy::kUncertain}) {
    BoxLearner learner(lot.image, options_of(policy));
    teach(lot, 4, learner);
    ASSERT_TRUE(learner.learn());
    const auto found = learner.found();
    const auto asked = learner.questions(10);
    const auto before = learner.hypotheses();
    ASSERT_GT(found.size(), 4U);
    ASSERT_LT(found.size(), 4U + before.size());
    std::size_t likely = 0;
    for (const Hypothesis& h : before)
      likely += logistic_gaussian(h.prediction.mean, h.prediction.variance) >= 0.5 ? 1U : 0U;
    EXPECT_EQ(found.size(), 4U + likely);
    for (std::size_t i = 0; i < before.size(); ++i) learner.answer(i, i % 8 == 7);
    ASSERT_TRUE(learner.learn());
    EXPECT_LT(learner.classifier()->shift(), -0.1);
    ASSERT_EQ(learner.hypotheses().size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_LT(learner.hypotheses()[i].prediction.probability, before[i].prediction.probability);
    EXPECT_TRUE(same_boxes(learner.found(), found));
    EXPECT_EQ(learner.questions(10), asked);
  }
}

// A factor on the logit does not change the found boxes or the questions.
TEST(BoxLearner, ASharperProbabilityFindsAndAsksTheSame) {
  const OutlinedBoxes lot = outlined_boxes(30, 12);
  BoxLearner sharp(lot.image, options_of(QuestionPolicy::kTelling));
  BoxLearner plain(lot.image, options_of(QuestionPolicy::kTelling, false));
  for (BoxLearner* learner : {&sharp, &plain}) {
    teach(lot, 4, *learner);
    ASSERT_TRUE(learner->learn());
  }
  ASSERT_GT(sharp.classifier()->sharpness(), 1.1);
  ASSERT_EQ(plain.classifier()->sharpness(), 1.0);
  EXPECT_TRUE(same_boxes(sharp.found(), plain.found()));
  EXPECT_EQ(sharp.questions(10), plain.questions(10));
}

// An answer is stored with the logit without the shift. An answer therefore counts the same in any
// round.
TEST(BoxLearner, AnAnswerIsKeptWithTheLogitBeforeTheShift) {
  const OutlinedBoxes lot = outlined_boxes(20, 13);
  BoxLearner learner(lot.image, options_of(QuestionPolicy::kTelling));
  teach(lot, 4, learner);
  ASSERT_TRUE(learner.learn());
  const auto logit = [&](std::size_t i) {
    const GpPrediction& p = learner.hypotheses()[i].prediction;
    return learner.classifier()->sharpness() * logit_of(logistic_gaussian(p.mean, p.variance));
  };
  learner.answer(0, true);
  learner.answer(7, false);
  ASSERT_EQ(learner.answers().size(), 2U);
  EXPECT_NEAR(learner.answers()[0].logit, logit(0), 1e-6);
  EXPECT_TRUE(learner.answers()[0].positive);
  EXPECT_NEAR(learner.answers()[1].logit, logit(7), 1e-6);
  EXPECT_FALSE(learner.answers()[1].positive);
  for (std::size_t i = 10; i < 30; ++i) learner.answer(i, false);
  ASSERT_TRUE(learner.learn());
  ASSERT_NE(learner.classifier()->shift(), 0.0);
  EXPECT_NEAR(learner.classifier()->shift(), prior_shift(learner.answers()), 1e-12);
  learner.answer(3, true);
  EXPECT_NEAR(learner.answers().back().logit, logit(3), 1e-6);
}

// Both policies of [environment representation]: random places from the first round on; or "only
// rejected hypotheses ..., thus at epoch 1 there is only one negative: the vector 0".
TEST(BoxLearner, WithRejectedNegativesAloneTheVectorZeroIsTheFirst) {
  const OutlinedBoxes lot = outlined_boxes(20, 14);
  BoxLearnerOptions options = options_of(QuestionPolicy::kTelling);
  options.random_negatives = 30;
  const auto examples_after = [&](NegativePolicy policy, std::size_t rejected) {
    options.negatives = policy;
    BoxLearner learner(lot.image, options);
    teach(lot, 3, learner);
    for (std::size_t i = 0; i < rejected; ++i) {
      OrientedBox box = lot.spaces[10 + i];
      box.heading += 0.7;
      learner.add_negative(box);
    }
    EXPECT_TRUE(learner.gather());
    return learner.examples();
  };
  EXPECT_EQ(negatives_of(examples_after(NegativePolicy::kRandom, 0)), 30U);
  EXPECT_EQ(negatives_of(examples_after(NegativePolicy::kRandom, 5)), 35U);
  const auto zeros = [](const BoxExamples& examples) {
    std::size_t count = 0;
    for (Eigen::Index i = 0; i < examples.features.rows(); ++i)
      if (examples.features.row(i).isZero(0.0)) {
        EXPECT_EQ(examples.labels[static_cast<std::size_t>(i)], -1);
        ++count;
      }
    return count;
  };
  for (const std::size_t rejected : {0U, 5U}) {
    const BoxExamples examples = examples_after(NegativePolicy::kRejected, rejected);
    EXPECT_EQ(negatives_of(examples), 1U + rejected);
    EXPECT_EQ(zeros(examples), 1U);
  }
}

// Before the first rejection, the hypotheses are the windows that look like the drawn boxes.
TEST(BoxLearner, AFirstRoundFromBoxesAloneFindsWhatLooksLikeThem) {
  const OutlinedBoxes lot = outlined_boxes(30, 17);
  BoxLearnerOptions options = options_of(QuestionPolicy::kTelling);
  options.negatives = NegativePolicy::kRejected;
  BoxLearner learner(lot.image, options);
  teach(lot, 4, learner);
  ASSERT_TRUE(learner.learn());
  ASSERT_EQ(negatives_of(learner.examples()), 1U);
  // The best 26 hypotheses are the 26 other boxes, with few exceptions. Random boxes would hit one
  // or two.
  std::vector<OrientedBox> best;
  for (std::size_t i = 0; i < 26; ++i) best.push_back(learner.hypotheses().at(i).box);
  const auto match = match_boxes(best, lot.spaces, 0.5);
  EXPECT_GE(std::count_if(match.begin(), match.end(), [](int m) { return m >= 0; }), 20);
}

}  // namespace
}  // namespace roadbook
