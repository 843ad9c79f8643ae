#include <gtest/gtest.h>

#include "apps/report/diagnosis_page.hpp"
#include "workflows/diagnosis/diagnosis_json.hpp"

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
  EXPECT_TRUE(to_lines(d).front().starts_with(
      "wheels0.radius = -0.4840 (95 %: -0.4851 to -0.4830), held-out gain"))
      << to_lines(d).front();
}

// The text, the JSON and the page all mark the size.
TEST(DiagnosisLines, ASizeFarBeyondThePlausibleIsMarkedDoubtful) {
  Diagnosis d;
  FoundCause cause;
  cause.effect = "steering0.ratio";
  cause.unit = "1";
  cause.size = 0.82;
  d.causes.push_back(cause);
  const std::string doubt =
      "doubtful: 16 times the plausible size (0.05); check unit and sign, or the true cause is not "
      "in the catalogue";
  EXPECT_EQ(to_lines(d).at(1), "  " + doubt);
  EXPECT_EQ(to_json(d)["causes"][0]["doubt"], doubt);
  EXPECT_NE(diagnosis_page(d, "drive").find("<b>" + doubt), std::string::npos);
  d.causes.front().size = 0.1;
  EXPECT_FALSE(to_json(d)["causes"][0].contains("doubt"));
}

}  // namespace
}  // namespace roadbook
