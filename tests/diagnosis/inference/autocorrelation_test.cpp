#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "diagnosis/inference/check_notes.hpp"

namespace roadbook {
namespace {

// Warnings for the residuals of one channel.
std::vector<std::string> said_of(const std::vector<double>& values,
                                 const std::vector<std::string>& correlated) {
  Innovations left;
  left.sides = 1;
  left.values = values;
  left.of.resize(values.size());
  const std::vector<ChannelName> channels{{"steering0", "angle"}};
  return autocorrelations(channels, left, check_innovations(left, channels), correlated);
}

TEST(Autocorrelation, ThatACorrelationOfTheNoiseIsNamedForIsExplained) {
  Random random(3);
  std::vector<double> values;
  double last = 0.0;
  for (int k = 0; k < 3000; ++k) values.push_back(last = 0.5 * last + random.normal());
  const std::vector<std::string> flagged{"autocorrelation in steering0 (angle)"};
  EXPECT_EQ(said_of(values, {}), flagged);
  EXPECT_EQ(said_of(values, {"imu0"}), flagged);
  EXPECT_TRUE(said_of(values, {"steering0"}).empty());
}

// A sine wave is not first-order noise, whatever was named.
TEST(Autocorrelation, BeyondTheFirstOrderStaysUnexplained) {
  Random random(4);
  std::vector<double> values;
  for (int k = 0; k < 3000; ++k) values.push_back(random.normal() + std::sin(0.4 * k));
  EXPECT_EQ(said_of(values, {"steering0"}).size(), 1U);
}

TEST(Autocorrelation, OfWhiteRowsNothingIsSaid) {
  Random random(5);
  std::vector<double> values;
  for (int k = 0; k < 3000; ++k) values.push_back(random.normal());
  EXPECT_TRUE(said_of(values, {}).empty());
}

TEST(CheckInnovations, AChannelNeeds40ThatAreNotVague) {
  for (const std::size_t count : {39U, 40U}) {
    Innovations left;
    left.sides = 1;
    left.of.resize(count);
    for (std::size_t i = 0; i < count; ++i) left.values.push_back(i % 3 == 0 ? 1.0 : -0.5);
    const std::vector<ChannelName> channels{{"steering0", "angle"}};
    const auto checks = check_innovations(left, channels);
    ASSERT_EQ(checks.size(), count < 40 ? 0U : 1U);
    for (const ChannelCheck& check : checks) EXPECT_EQ(check.rows, count);
    left.of.front().variance = kVague;
    EXPECT_TRUE(check_innovations(left, channels).empty());
  }
}

}  // namespace
}  // namespace roadbook
