#include "vo/wheels/wheel_signs.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "tests/vo/wheel_drive.hpp"
#include "vo/wheels/false_times.hpp"
#include "vo/wheels/wheel_doubts.hpp"

namespace roadbook::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr double kHeight_m = 1.0;

// An odometry with keyframes every 0.1 s that used these wheels, and followed them.
VoResult odometry_with(const WheelOdometry& wheels) {
  VoResult odometry = sight_of();
  for (std::size_t k = 0; k < odometry.keyframes.size(); ++k) {
    VoKeyframe& keyframe = odometry.keyframes[k];
    keyframe.features.resize(1);
    keyframe.features[0].pixels.resize(300);
    if (k > 0) keyframe.wheels = wheels.between(odometry.keyframes[k - 1].t_ns, keyframe.t_ns);
  }
  return odometry;
}

bool holds(const TimeSpan& span, double from_s, double to_s) {
  return span.first <= static_cast<std::int64_t>(from_s * 1e9) &&
         span.second >= static_cast<std::int64_t>(to_s * 1e9);
}

TEST(WheelSigns, SoundWheelsShowNone) {
  const WheelModel model;
  const WheelOdometry wheels(model, readings_of(model));
  EXPECT_FALSE(find_wheel_signs(odometry_with(wheels), wheels, kHeight_m).any());
}

// Corners that agree with no motion near the wheels' are a sign; an image without corners is not.
TEST(WheelSigns, CornersThatDoNotAgreeShowTheTime) {
  const WheelModel model;
  const WheelOdometry wheels(model, readings_of(model));
  VoResult odometry = odometry_with(wheels);
  for (std::size_t k = 100; k < 110; ++k) odometry.keyframes[k].inliers = 3;
  for (std::size_t k = 200; k < 210; ++k) {
    odometry.keyframes[k].inliers = 0;
    odometry.keyframes[k].features[0].pixels.resize(10);
  }
  const auto signs = find_wheel_signs(odometry, wheels, kHeight_m);
  ASSERT_EQ(signs.spans.size(), 1U);
  EXPECT_TRUE(holds(signs.spans[0], 10.0, 10.9));
  EXPECT_LT(signs.spans[0].second - signs.spans[0].first, 2 * kSecond);
  EXPECT_FALSE(signs.scale);
}

TEST(WheelSigns, TurnsThatTheCamerasSeeOtherwiseShowTheTime) {
  const WheelModel model;
  WheelOdometry wheels(model, readings_of(model));
  VoResult odometry = odometry_with(wheels);
  for (std::size_t k = 150; k < 156; ++k) odometry.keyframes[k].turn_beyond_wheels_rad = 0.03;
  const auto signs = find_wheel_signs(odometry, wheels, kHeight_m);
  ASSERT_EQ(signs.spans.size(), 1U);
  EXPECT_TRUE(holds(signs.spans[0], 15.0, 15.5));
  EXPECT_LT(signs.spans[0].second - signs.spans[0].first, 4 * kSecond);
  // A tenth of that in either direction is what sound wheels and corners differ by.
  for (std::size_t k = 150; k < 156; ++k) odometry.keyframes[k].turn_beyond_wheels_rad *= 0.1;
  EXPECT_FALSE(find_wheel_signs(odometry, wheels, kHeight_m).any());
}

// Turns before a time without wheels do not count after it.
TEST(WheelSigns, ATimeWithoutWheelsSeparates) {
  const WheelModel model;
  const WheelOdometry wheels(model, readings_of(model));
  VoResult odometry = odometry_with(wheels);
  const auto with_turns = [&](bool apart) {
    VoResult result = odometry;
    for (std::size_t k = 150; k < 158; ++k) result.keyframes[k].turn_beyond_wheels_rad = 0.0055;
    if (apart) result.keyframes[154].wheels.reset();
    return find_wheel_signs(result, wheels, kHeight_m).any();
  };
  EXPECT_TRUE(with_turns(false));
  EXPECT_FALSE(with_turns(true));
}

TEST(JudgeSpans, SoundWheelsAreNotDoubtedAndLostCamerasKnowNothing) {
  const WheelModel model;
  const WheelOdometry wheels(model, readings_of(model));
  VoResult odometry = sight_of(1.0);
  for (std::size_t k = 200; k < 220; ++k) odometry.keyframes[k].inliers = 0;
  const auto verdicts =
      judge_spans({{5 * kSecond, 7 * kSecond}, {20 * kSecond, 22 * kSecond}}, odometry, wheels);
  ASSERT_EQ(verdicts.size(), 2U);
  EXPECT_TRUE(verdicts[0].is_known);
  EXPECT_FALSE(verdicts[0].is_doubted);
  EXPECT_FALSE(verdicts[1].is_known);
}

TEST(JudgeSpans, WheelsThatStandAreDoubtedInTheirTimeAlone) {
  const WheelModel model;
  for (const int side : {0, 1, 2}) {
    auto readings = readings_of(model);
    hold(readings, 12.0, 1.0, side != 1, side != 0);
    const WheelOdometry wheels(model, std::move(readings));
    const std::vector<TimeSpan> spans{{5 * kSecond, 7 * kSecond}, {12 * kSecond, 13 * kSecond}};
    const auto verdicts = judge_spans(spans, sight_of(1.0), wheels);
    EXPECT_FALSE(verdicts[0].is_doubted) << side;
    EXPECT_TRUE(verdicts[1].is_doubted) << side;
    const auto sizes = compare_wheels_in({spans[1]}, sight_of(1.0), wheels);
    EXPECT_NEAR(sizes.doubts.at(0).way_m, side == 2 ? -kSpeed_m_s : -0.5 * kSpeed_m_s, 0.3) << side;
    EXPECT_TRUE(sizes.rest_is_useful());
  }
}

// Cameras alone at the start know lengths up to a factor: a way that is a fifth longer
// says nothing about the wheels, a way that is missing does.
TEST(JudgeSpans, WithoutScaleOnlyGrossWaysAreDoubted) {
  const WheelModel model;
  const std::vector<TimeSpan> span{{5 * kSecond, 8 * kSecond}};
  const WheelOdometry sound(model, readings_of(model));
  EXPECT_FALSE(judge_spans(span, sight_of(1.4), sound).at(0).is_doubted);
  VoResult scaled = sight_of(1.4);
  for (std::size_t k = 1; k < 50; ++k)
    scaled.keyframes[k].wheels =
        sound.between(scaled.keyframes[k - 1].t_ns, scaled.keyframes[k].t_ns);
  EXPECT_TRUE(judge_spans(span, scaled, sound).at(0).is_doubted);
  auto readings = readings_of(model);
  hold(readings, 5.5, 1.0, true, true);
  const WheelOdometry standing(model, std::move(readings));
  EXPECT_TRUE(judge_spans(span, sight_of(1.4), standing).at(0).is_doubted);
}

// A camera whose images come at other instants than those of the others is no sign.
TEST(WheelSigns, KeyframesOfDifferentCamerasShowNothing) {
  const WheelModel model;
  const WheelOdometry wheels(model, readings_of(model));
  VoResult odometry = odometry_with(wheels);
  for (std::size_t k = 0; k < odometry.keyframes.size(); ++k) {
    auto& features = odometry.keyframes[k].features;
    features.resize(4, features[0]);
    for (std::size_t c = 0; c < 4; ++c)
      if ((c == 3) != (k % 2 == 1)) features[c] = {};
    odometry.keyframes[k].inliers = 5;
  }
  EXPECT_FALSE(find_wheel_signs(odometry, wheels, kHeight_m).any());
}

// A step is one time between two readings, a spike two that touch. Both in the wheels' own clock.
TEST(ImpossibleTimes, AreThoseThatNoCarDrives) {
  WheelModel model;
  model.time_offset_s = 0.25;
  auto readings = readings_of(model);
  EXPECT_TRUE(impossible_times(model, readings).empty());
  for (std::size_t i = 500; i < readings.size(); ++i) readings[i].left_angle_rad += 20.0;
  readings[800].right_angle_rad -= 30.0;
  const auto times = impossible_times(model, readings);
  const std::vector<TimeSpan> expected{{10'230'000'000, 10'250'000'000},
                                       {16'230'000'000, 16'270'000'000}};
  EXPECT_EQ(times, expected);
}

}  // namespace
}  // namespace roadbook::test
