#include "mapping/wheel_scale_doubt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace roadbook {
namespace {

// The mean of data that say `error` with sigma 0.0025 and of a prior 0 with sigma 0.005.
Session session_with(double error) {
  Session session;
  session.scale_source = ScaleSource::kWheels;
  session.wheel_scale = 1.0 + 0.8 * error;
  session.wheel_scale_sigma = 0.0025 * std::sqrt(0.8);
  return session;
}

TEST(WheelScaleDoubt, NamesTwoPerCentAndNotHalfAPerCent) {
  const auto doubt = doubt_of_wheel_scale(session_with(0.02), 0.005, "monday");
  ASSERT_TRUE(doubt);
  EXPECT_EQ(doubt->file, "monday/wheels0");
  EXPECT_EQ(doubt->got, "wheels that look 2.0 % too small (+- 0.3 %)");
  EXPECT_FALSE(doubt_of_wheel_scale(session_with(0.005), 0.005, "monday"));
  EXPECT_FALSE(doubt_of_wheel_scale(session_with(-0.0099), 0.005, "monday"));
}

TEST(WheelScaleDoubt, NeedsAStandardErrorAndWheels) {
  Session unknown = session_with(0.05);
  unknown.wheel_scale_sigma = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(doubt_of_wheel_scale(unknown, 0.005, "monday"));
  Session loose = session_with(0.02);
  loose.wheel_scale = 1.0016;  // the prior pulls it back from 2 %
  loose.wheel_scale_sigma = 0.0048;
  EXPECT_FALSE(doubt_of_wheel_scale(loose, 0.005, "monday"));
  Session sight = session_with(0.05);
  sight.scale_source = ScaleSource::kCameraHeight;
  EXPECT_FALSE(doubt_of_wheel_scale(sight, 0.005, "monday"));
}

}  // namespace
}  // namespace roadbook
