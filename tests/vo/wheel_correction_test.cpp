#include "vo/wheels/wheel_correction.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "tests/vo/wheel_drive.hpp"

namespace roadbook::test {
namespace {

constexpr double kGround = 1.0 / kSightScale;  // puts the ground at the cameras' height

// What a user may have done to wheels, in the words of a correction.
struct Mistake {
  bool exchange = false;
  bool left = false;
  bool right = false;
  double radius = 1.0;
  double track = 1.0;
};

std::optional<WheelCorrection> found(const Mistake& mistake, std::optional<double> ground) {
  WheelModel model;
  auto readings = readings_of(model);
  for (WheelReading& r : readings) {
    if (mistake.left) r.left_angle_rad = -r.left_angle_rad;
    if (mistake.right) r.right_angle_rad = -r.right_angle_rad;
    if (mistake.exchange) std::swap(r.left_angle_rad, r.right_angle_rad);
  }
  model.radius_left_m *= mistake.radius;
  model.radius_right_m *= mistake.radius;
  model.track_width_m *= mistake.track;
  return find_wheel_correction(sight_of(), model, readings, ground);
}

void expect_found(const Mistake& mistake, const std::optional<WheelCorrection>& c) {
  SCOPED_TRACE(testing::Message() << mistake.exchange << mistake.left << mistake.right << " radius "
                                  << mistake.radius << " track " << mistake.track);
  ASSERT_TRUE(c);
  EXPECT_EQ(c->exchange, mistake.exchange);
  EXPECT_EQ(c->left_sign < 0.0, mistake.left);
  EXPECT_EQ(c->right_sign < 0.0, mistake.right);
  EXPECT_NEAR(c->radius_factor, 1.0 / mistake.radius, 1e-12);
  EXPECT_NEAR(c->track_factor, 1.0 / mistake.track, 0.03 / mistake.track);
}

TEST(WheelCorrection, UndoesEachMistakeOfWiringAndMeasures) {
  for (const bool exchange : {false, true})
    for (const int signs : {0, 1, 2, 3})
      for (const double radius : signs == 1 ? std::vector{1.0, 0.5, 2.0} : std::vector{1.0}) {
        const Mistake mistake{exchange, (signs & 1) != 0, (signs & 2) != 0, radius, 1.0};
        expect_found(mistake, found(mistake, kGround));
      }
  for (const double track : {0.5, 2.0, 1.3, 0.8}) {
    const Mistake mistake{track < 1.0, false, false, 1.0, track};
    expect_found(mistake, found(mistake, kGround));
  }
}

TEST(WheelCorrection, LeavesSoundWheelsAlone) {
  const auto sound = found({}, kGround);
  ASSERT_TRUE(sound);
  EXPECT_FALSE(sound->is_needed());
}

// Only the ground distinguishes a diameter from a radius. The wiring shows without it.
TEST(WheelCorrection, GuessesNoRadiusWithoutGround) {
  const auto twice = found({false, false, false, 2.0, 1.0}, std::nullopt);
  EXPECT_TRUE(!twice || twice->radius_factor == 1.0);
  const Mistake mistake{true, true, true, 1.0, 1.0};
  expect_found(mistake, found(mistake, std::nullopt));
}

// A wheel that does not turn in a part of the drive is not a mistake of wiring.
TEST(WheelCorrection, KnowsNoneForWheelsThatStand) {
  for (const double seconds : {2.0, 13.0, 25.0}) {
    WheelModel model;
    auto readings = readings_of(model);
    hold(readings, 10.0, seconds, true, false);
    const auto c = find_wheel_correction(sight_of(), model, readings, kGround);
    EXPECT_FALSE(c && c->is_needed()) << seconds << " s: " << c->text();
  }
}

TEST(WheelCorrection, NamesTheMistakes) {
  WheelCorrection c;
  c.exchange = true;
  c.right_sign = -1.0;
  c.track_factor = 2.0;
  EXPECT_EQ(c.text(),
            "left and right exchanged and the right wheel counting backwards and a track width "
            "0.50 times the true one");
}

}  // namespace
}  // namespace roadbook::test
