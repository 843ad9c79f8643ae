#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>

#include "apps/evaluation/pictures/painted_lot.hpp"
#include "base/error.hpp"
#include "semantics/detector/label_oracle.hpp"

namespace roadbook {
namespace {

// This is the short version of `roadbook evaluate labels`: 24 spaces in an overhead image and few
// drawn boxes.
TEST(LabelCurve, AFewBoxesAndClicksFindMostSpacesOfAWornFloor) {
  const PaintedLot lot = painted_lot("stuttgart", "small", 2, 0);
  ASSERT_EQ(lot.spaces.size(), 24U);
  OracleOptions options;
  options.first_boxes = 3;
  options.boxes_a_round = 1;
  options.max_boxes = 8;
  options.rounds = 4;
  options.questions_a_round = 10;
  std::vector<OrientedBox> labelled;
  std::size_t answers = 0;
  options.after_round = [&](const BoxLearner& learner) {
    labelled = learner.positives();
    answers = learner.answers().size();
  };
  const OracleResult result = play_oracle(lot.image, lot.spaces, options);
  const OracleRound& last = result.rounds.back();
  // Only a drawn or a corrected box lies exactly on its space. A corrected box costs a second click
  // in addition to its answer.
  const auto exact = std::count_if(labelled.begin(), labelled.end(), [&](const OrientedBox& box) {
    return std::find(lot.spaces.begin(), lot.spaces.end(), box) != lot.spaces.end();
  });
  EXPECT_GT(last.put_right, 0);
  EXPECT_EQ(last.drawn + last.put_right, exact);
  EXPECT_EQ(last.clicks - last.put_right, static_cast<int>(answers));
  EXPECT_LE(last.drawn, 6);
  EXPECT_GT(last.f1, 0.8);
  EXPECT_GT(result.rounds.back().f1, result.rounds.front().f1 - 0.05) << "labels do not harm";
}

TEST(LabelCurve, TheSameClicksTeachTheSameOnAnyNumberOfThreadsAndFewerSomethingElse) {
  const PaintedLot lot = painted_lot("stuttgart", "small", 2, 0);
  OracleOptions options;
  options.first_boxes = 3;
  options.rounds = 2;
  options.questions_a_round = 10;
  options.learner.search.num_threads = 2;
  const auto play = [&] { return play_oracle(lot.image, lot.spaces, options).rounds; };
  const auto told = play();
  options.learner.search.num_threads = 1;
  const auto again = play();
  for (std::size_t r = 0; r < told.size(); ++r) {
    EXPECT_EQ(told[r].classifier.size(), 16U);
    EXPECT_EQ(again[r].classifier, told[r].classifier) << r;
  }
  options.questions_a_round = 9;
  EXPECT_NE(play()[1].classifier, told[1].classifier);
}

TEST(OracleOptions, OneRoundIsEnough) {
  OracleOptions options;
  options.rounds = 1;
  EXPECT_NO_THROW(options.check());
  options.rounds = 0;
  EXPECT_THROW(options.check(), InvalidOption);
}

// The model has learned from another floor, so one drawn box is enough where five were needed.
TEST(LabelCurve, ASecondFloorNeedsLessThanAThirdOfTheBoxes) {
  const PaintedLot first = painted_lot("stuttgart", "small", 2, 0);
  const PaintedLot second = painted_lot("stuttgart", "small", 3, 0);
  OracleOptions options;
  options.first_boxes = 3;
  options.boxes_a_round = 1;
  options.rounds = 3;
  options.questions_a_round = 10;
  BoxExamples taught;
  options.after_round = [&](const BoxLearner& learner) { taught = learner.examples(); };
  (void)play_oracle(first.image, first.spaces, options);
  options.after_round = nullptr;
  const OracleRound alone = play_oracle(second.image, second.spaces, options).rounds.back();
  options.start = taught;
  options.first_boxes = 0;
  options.max_boxes = 1;
  const OracleResult after = play_oracle(second.image, second.spaces, options);
  EXPECT_EQ(alone.drawn, 5);
  EXPECT_EQ(after.rounds.back().drawn, 1);
  EXPECT_GE(after.rounds.back().f1, alone.f1);
  EXPECT_GT(after.rounds.front().f1, 0.7) << "before anything is drawn";
}

TEST(PaintedLot, AnotherFloorHasTheSameSpacesAndAnotherFace) {
  const PaintedLot a = painted_lot("stuttgart", "small", 1, 1);
  const PaintedLot again = painted_lot("stuttgart", "small", 1, 2);
  const PaintedLot b = painted_lot("stuttgart", "small", 2, 1);
  ASSERT_EQ(a.spaces.size(), b.spaces.size());
  EXPECT_LT((a.spaces[5].centre - b.spaces[5].centre).norm(), 1e-9);
  EXPECT_EQ(cv::norm(a.image.grey, again.image.grey, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(a.image.grey, b.image.grey, cv::NORM_L1),
            5.0 * static_cast<double>(a.image.grey.total()));
}

}  // namespace
}  // namespace roadbook
