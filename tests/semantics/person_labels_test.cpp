#include "semantics/person_labels.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace roadbook
