#include "semantics/people/person_labels.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace roadbook {
namespace {

PersonExamples of(std::initializer_list<std::pair<float, int>> values) {
  PersonExamples examples;
  for (const auto& [value, label] : values) {
    examples.features.push_back(Eigen::VectorXf::Constant(3, value));
    examples.labels.push_back(static_cast<std::int8_t>(label));
  }
  return examples;
}

TEST(PersonExamples, WhatIsTaughtTwiceCountsOnce) {
  const PersonExamples known = of({{1.0F, 1}, {2.0F, -1}});
  const PersonExamples all = joined(known, of({{2.0F, -1}, {3.0F, 1}, {1.0F, 1}}));
  EXPECT_EQ(all.labels, (std::vector<std::int8_t>{1, -1, 1}));
  EXPECT_EQ(all.features.back(), Eigen::VectorXf::Constant(3, 3.0F));
  EXPECT_EQ(joined(all, all).size(), all.size());
}

TEST(PersonExamples, OneWindowJudgedBothWaysIsKeptBothWays) {
  EXPECT_EQ(joined(of({{1.0F, 1}}), of({{1.0F, -1}})).size(), 2U);
}

TEST(PersonExamples, AnswersAreWhatWasSaidAboutWindowsThatWereFound) {
  std::vector<Label> labels(5);
  for (Label& label : labels) label.shape = LabelShape::kUpright;
  labels[0].kind = kPersonKind;
  labels[0].source = LabelSource::kAccepted;
  labels[0].score = 0.8;
  labels[1].kind = "not_person";
  labels[1].source = LabelSource::kDetected;
  labels[1].score = 0.2;
  labels[2].kind = kPersonKind;  // drawn by hand, not found by a search
  labels[3].kind = kPersonKind;
  labels[3].source = LabelSource::kAccepted;
  labels[3].shape = LabelShape::kBox;  // on the ground
  labels[4].kind = kPersonKind;
  labels[4].source = LabelSource::kAccepted;  // the probability of the search is not known
  const auto answers = answers_of(labels);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_TRUE(answers[0].positive);
  EXPECT_FALSE(answers[1].positive);
  EXPECT_NEAR(answers[0].logit, std::log(4.0), 1e-12);
  EXPECT_NEAR(answers[1].logit, -std::log(4.0), 1e-12);
  PersonExamples once;
  once.answers = answers;
  EXPECT_EQ(joined(once, once).answers, answers) << "said twice counts once";
}

}  // namespace
}  // namespace roadbook
