#include "diagnosis/findings.hpp"

#include <gtest/gtest.h>

#include "diagnosis/reading_diagnosis.hpp"

namespace roadbook {
namespace {

Diagnosis of(std::vector<std::string> looked_for, std::vector<std::string> not_observable) {
  Diagnosis d;
  d.looked_for = std::move(looked_for);
  d.not_observable = std::move(not_observable);
  return d;
}

TEST(Findings, WhatOneOfTwoDrivesShowsIsObservableAndWhatNoneDoesIsSaidOnce) {
  const Diagnosis one = of({"a", "b", "c"}, {"a", "b"});
  const Diagnosis other = of({"a", "b", "d"}, {"a", "d"});
  for (const bool swapped : {false, true}) {
    Diagnosis all = swapped ? other : one;
    add_findings(swapped ? one : other, all);
    EXPECT_EQ(all.not_observable, (std::vector<std::string>{"a", "d"}));
    EXPECT_EQ(all.looked_for.size(), 4U);
  }
}

}  // namespace
}  // namespace roadbook
