#include "apps/evaluation/pictures/label_pictures.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "apps/evaluation/pictures/ground_view_fit.hpp"
#include "base/error.hpp"
#include "base/random.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

constexpr double kFocalPx = 1100.0;
constexpr double kTilt = 0.55;
constexpr double kHeightM = 14.0;
const cv::Size kPicture(1280, 720);

// Projects by hand into a level camera at (0, 0, 14 m) that looks along y and is tilted down.
Eigen::Vector2d seen_at(const Eigen::Vector2d& p) {
  const double forward = p.y() * std::cos(kTilt) + kHeightM * std::sin(kTilt);
  const double down = -p.y() * std::sin(kTilt) + kHeightM * std::cos(kTilt);
  return {0.5 * kPicture.width + kFocalPx * p.x() / forward,
          0.5 * kPicture.height + kFocalPx * down / forward};
}

TEST(GroundView, OutlinesOfSpacesTellHowACameraSeesTheGround) {
  Random random(5, "outlines");
  std::vector<OrientedBox> spaces;
  std::vector<QuadOutline> outlines;
  for (int i = 0; i < 30; ++i) {
    const OrientedBox box{{-9.0 + 3.0 * (i % 6), 16.0 + 5.5 * (i / 6)},
                          i % 2 == 0 ? 0.4 : 0.4 + std::numbers::pi / 2,
                          5.0,
                          2.4};
    QuadOutline outline;
    for (std::size_t k = 0; k < 4; ++k)  // error of 1 or 2 px, one of ten badly drawn
      outline[k] = seen_at(box.corners()[k]) +
                   (i % 10 == 7 ? 12.0 : 1.5) * Eigen::Vector2d(random.normal(), random.normal());
    spaces.push_back(box);
    outlines.push_back(outline);
  }
  const FittedGround view = fit_ground_view(outlines, kPicture, 5.0 * 2.4);
  EXPECT_NEAR(view.boxes[0].length_m, 5.0, 0.15);
  EXPECT_NEAR(view.boxes[0].width_m, 2.4, 0.1);
  EXPECT_LT(view.side_spread, 0.08);
  for (const auto& [a, b] : {std::pair{0, 5}, std::pair{0, 24}, std::pair{3, 29}}) {
    const auto far = [&](const std::vector<OrientedBox>& boxes) {
      return (boxes[static_cast<std::size_t>(a)].centre - boxes[static_cast<std::size_t>(b)].centre)
          .norm();
    };
    EXPECT_NEAR(far(view.boxes) / far(spaces), 1.0, 0.04) << a << ' ' << b;
  }
}

TEST(AnnotatedCarParks, AFolderWithoutAnnotatedPicturesIsRefused) {
  EXPECT_THROW((void)read_annotated_car_parks("/nonexistent", true), BadInput);
  EXPECT_THROW((void)read_annotated_car_parks(test::source_tree() / "docs", true), BadInput);
}

double first_seen(const AnnotatedCarPark& lot) { return seen_share(lot.image, lot.spaces.front()); }

TEST(AnnotatedCarParks, ARoofCamerasCarParkLiesRectifiedAndHalvedOnTwoDays) {
  ROADBOOK_REQUIRE_DATA(data, "pklot_ufpr05");
  const auto lots = pklot_annotations(data);
  ASSERT_EQ(lots.size(), 4U);
  for (const AnnotatedCarPark& lot : lots) {
    // Five images show 40 spaces, with a group of 20 in each half.
    EXPECT_EQ(lot.spaces.size(), 100U) << lot.name;
    EXPECT_GE(first_seen(lot), 0.6);
  }
  // Each day has its own outlines and its own rectification. Both days must give the same car park.
  for (const std::size_t island : {0U, 1U}) {
    const auto extent = [&](const AnnotatedCarPark& lot) {
      return (lot.spaces[0].centre - lot.spaces[9].centre).norm();
    };
    EXPECT_NEAR(extent(lots[island]) / extent(lots[island + 2]), 1.0, 0.05);
  }
}

// The few labels on one half of a drive must find spaces on the other half. This is a small version
// of `roadbook evaluate labels --data`.
TEST(AnnotatedCarParks, TheFirstHalfOfADriveTeachesTheSecond) {
  ROADBOOK_REQUIRE_DATA(data, "psv_avm");
  const auto lots = psv_annotations(data / "Oblique", 10);
  ASSERT_EQ(lots.size(), 2U);
  EXPECT_GE(first_seen(lots[0]), 0.6);
  OracleOptions options;
  options.rounds = 2;
  options.first_boxes = 4;
  options.questions_a_round = 10;
  OracleResult own;
  const auto transfers = play_transfer(lots, 0, {1}, options, own);
  ASSERT_EQ(transfers.front().rounds.size(), 2U);
  EXPECT_GT(transfers.front().rounds.back().recall, 0.5);
  EXPECT_GT(own.rounds.back().f1, own.rounds.front().f1);
}

}  // namespace
}  // namespace roadbook
