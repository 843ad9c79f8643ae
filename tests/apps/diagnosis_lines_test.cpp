#include <gtest/gtest.h>

#include "apps/diagnosis_json.hpp"

namespace roadbook {
namespace {

TEST(DiagnosisLines, SizesHaveAsManyDigitsAsTheirIntervalsKnow) {
  Diagnosis d;
  FoundCause cause;
  cause.effect = "wheels0.radius";
  cause.unit = "1";
  cause.size = -0.48403684522073054;
  cause.low = -0.48507702249648960;
  cause.high = -0.48299666794497148;
  d.causes.push_back(cause);
  EXPECT_TRUE(
      to_lines(d).front().starts_with("wheels0.radius = -0.4840 (95 %: -0.4851 to -0.4830), gain"))
      << to_lines(d).front();
}

}  // namespace
}  // namespace roadbook
