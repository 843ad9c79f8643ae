#include <gtest/gtest.h>

#include <filesystem>

#include "diagnosis/reading_diagnosis.hpp"
#include "tests/diagnosis/example_log.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

Diagnosis of_example(const std::string& name, const std::filesystem::path& data) {
  return diagnose_readings(test::example_log(name, data).readings);
}

// A regression outside the program: 1.2 to 1.5 m too long within 25 m, 3.4 to 4.0 m beyond 45 m.
TEST(MeasuredReadings, RangesToTheMowersBeaconsGrowTooLongWithDistance) {
  ROADBOOK_REQUIRE_DATA(data, "plaza_mower");
  const Diagnosis d = of_example("plaza_mower.yaml", data);
  ASSERT_FALSE(d.causes.empty());
  EXPECT_EQ(d.causes.front().effect, "range0.scale");
  EXPECT_NEAR(d.causes.front().size, 0.07, 0.01);
  EXPECT_GT(d.causes.front().gain.low, 0.0);
}

// Of all readings 2.5 % stand at 81.83 m; of those that look at a wall not many fewer.
TEST(MeasuredReadings, ScansOfAnOfficeHaveMaximumReadingsAndShortOnes) {
  ROADBOOK_REQUIRE_DATA(data, "carmen_2d");
  const Diagnosis d = of_example("carmen_intel.yaml", data);
  ASSERT_EQ(d.causes.size(), 2U);
  EXPECT_EQ(d.causes[0].effect, "range0.maximum");
  EXPECT_NEAR(d.causes[0].size, 0.02, 0.005);
  EXPECT_EQ(d.causes[1].effect, "range0.short");
  EXPECT_NE(d.causes[1].note.find("moved objects"), std::string::npos);
  for (const FoundCause& c : d.causes) EXPECT_GT(c.gain.low, 0.0);
}

}  // namespace
}  // namespace roadbook
