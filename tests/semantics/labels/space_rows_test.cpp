#include "semantics/labels/space_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "base/error.hpp"
#include "base/random.hpp"
#include "tests/semantics/label_map.hpp"

namespace roadbook {
namespace {

constexpr double kWide = 2.5;
constexpr int kKeyframes = 160;  // half a metre apart
constexpr double kHalfPi = 0.5 * std::numbers::pi;

/// A space as drawn in the map, next to the road at its `x`.
OrientedBox space_at(double x, double y = 6.0, double heading = -kHalfPi) {
  return {{x, y}, heading, 5.0, kWide};
}

class SpaceRows : public ::testing::Test {
 protected:
  SpaceRows() {
    for (std::size_t k = 0; k < map_.map_frames.size(); ++k)
      map_.map_frames[k].T_map_frame = pose_from_planar(0.5 * static_cast<double>(k), 0.0, 0.0);
  }
  Label& draw(const OrientedBox& box) {
    OrientedBox drawn = box;
    drawn.centre += 0.03 * Eigen::Vector2d(hand_.normal(), hand_.normal());
    drawn.heading += 0.012 * hand_.normal();
    const auto k = static_cast<std::size_t>(
        std::clamp(std::lround(2.0 * box.centre.x()), 0L, static_cast<long>(kKeyframes - 1)));
    labels_.push_back(label_of_box(map_, {0, map_.keyframes[k].t_ns, 1}, drawn));
    labels_.back().kind = "parking_space";
    labels_.back().id = static_cast<std::int64_t>(labels_.size());
    return labels_.back();
  }
  void draw_row(int count, const std::function<OrientedBox(int)>& place) {
    for (int i = 0; i < count; ++i) draw(place(i));
  }
  [[nodiscard]] std::vector<EqualRow> rows() const { return space_rows(map_, labels_); }
  [[nodiscard]] std::vector<int> steps_of(std::size_t row) const {
    std::vector<int> steps;
    const std::vector<EqualRow> found = rows();
    for (const RowSpace& space : found.at(row).spaces) steps.push_back(space.steps);
    return steps;
  }

  Map map_ = test::label_map(kKeyframes);
  Random hand_{1, "hand"};
  std::vector<Label> labels_;
};

TEST_F(SpaceRows, SpacesWithAPillarBetweenAreOneRow) {
  for (const int i : {0, 1, 2, 3, 5, 6, 7}) draw(space_at(2.0 + kWide * i));
  ASSERT_EQ(rows().size(), 1U);
  EXPECT_EQ(steps_of(0), (std::vector<int>{0, 1, 2, 3, 5, 6, 7}));
}

TEST_F(SpaceRows, ALabelDrawnTheOtherWayRoundIsTurned) {
  draw_row(8,
           [](int i) { return space_at(2.0 + kWide * i, 6.0, i % 2 == 0 ? -kHalfPi : kHalfPi); });
  const auto found = rows();
  ASSERT_EQ(found.size(), 1U);
  ASSERT_EQ(found[0].spaces.size(), 8U);
  const auto heading = [&](const RowSpace& space) {
    const SpaceView& view = space.views.at(0);
    return heading_of(map_.T_map_vehicle(view.pose) * view.T_vehicle_space);
  };
  for (const RowSpace& space : found[0].spaces)
    EXPECT_NEAR(wrap_angle(heading(space) - heading(found[0].spaces[0])), 0.0, 6 * 0.012);
}

TEST_F(SpaceRows, RowsBackToBackStayApart) {
  draw_row(8, [](int i) { return space_at(2.0 + kWide * i); });
  draw_row(8, [](int i) { return space_at(2.0 + kWide * i, 11.0, kHalfPi); });
  const auto found = rows();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].spaces.size(), 8U);
  EXPECT_EQ(found[1].spaces.size(), 8U);
}

TEST_F(SpaceRows, SlantedSpacesAreARow) {
  const double slant = std::numbers::pi / 4.0;
  const double step = kWide / std::sin(slant);
  draw_row(8, [&](int i) { return space_at(2.0 + step * i, 6.0, slant); });
  ASSERT_EQ(rows().size(), 1U);
  EXPECT_EQ(rows()[0].spaces.size(), 8U);
}

// Bays of coaches, with a gap of two: 19 m from one label to the next.
TEST_F(SpaceRows, LongNarrowSpacesThatSlantMuchAreARowOverAGap) {
  constexpr double kBayWidth = 3.0;
  const double slant = std::atan2(1.0, 1.9);
  const double step = kBayWidth / std::sin(slant);
  const std::vector<int> labelled{0, 1, 2, 3, 6, 7, 8, 9};
  for (const int i : labelled) draw({{6.0 + step * i, 9.0}, slant, 12.0, kBayWidth});
  ASSERT_EQ(rows().size(), 1U);
  EXPECT_EQ(steps_of(0), labelled);
}

// The error of the map grows along the row. The row must still be found, because it shall correct
// this error.
TEST_F(SpaceRows, ARowOfABentMapIsStillOne) {
  draw_row(27, [](int i) { return space_at(2.0 + kWide * i); });
  for (std::size_t k = 0; k < map_.map_frames.size(); ++k) {
    const double way = 0.5 * static_cast<double>(k);
    map_.map_frames[k].T_map_frame =
        pose_from_planar(way, way * way / (2.0 * 2500.0), way / 2500.0);
  }
  ASSERT_EQ(rows().size(), 1U);
  EXPECT_EQ(rows()[0].spaces.size(), 27U);
}

TEST_F(SpaceRows, AWiderSpaceEndsARow) {
  draw_row(20, [](int i) {
    return space_at(2.0 + kWide * i + (i < 10 ? 0.0 : i == 10 ? 0.5 : 1.0));
  });
  const auto found = rows();
  ASSERT_EQ(found.size(), 2U);
  // The middle of the wide space lies half way between the two rows.
  EXPECT_LE(found[0].spaces.size(), 10U);
  EXPECT_LE(found[1].spaces.size(), 10U);
  EXPECT_GE(found[0].spaces.size() + found[1].spaces.size(), 18U);
}

TEST_F(SpaceRows, AnUnevenRowIsNotUsed) {
  Random uneven(2, "uneven");
  draw_row(27, [&](int i) { return space_at(2.0 + kWide * i + 0.4 * uneven.normal()); });
  EXPECT_TRUE(rows().empty());
}

TEST_F(SpaceRows, ARoundRowIsNotUsed) {
  constexpr double kRadius = 15.0;
  draw_row(8, [&](int i) {
    const double angle = kWide / kRadius * i;
    return space_at(2.0 + kRadius * std::sin(angle), 6.0 + kRadius * (1.0 - std::cos(angle)),
                    angle - kHalfPi);
  });
  EXPECT_TRUE(rows().empty());
}

TEST_F(SpaceRows, OneThatIsFarOffIsPassedOver) {
  draw_row(10, [](int i) { return space_at(2.0 + kWide * i, i == 4 ? 6.6 : 6.0); });
  ASSERT_EQ(rows().size(), 1U);
  EXPECT_EQ(rows()[0].spaces.size(), 9U);
}

TEST_F(SpaceRows, WhatIsNoLabelledSpaceIsLeftOut) {
  draw_row(7, [](int i) { return space_at(2.0 + kWide * i); });
  labels_[1].state = LabelState::kDeleted;
  labels_[2].kind = "not_parking_space";
  EXPECT_EQ(rows().at(0).spaces.size(), 5U);
  labels_[3].anchor.t_ns += 1;  // belongs to no keyframe
  EXPECT_TRUE(rows().empty());
}

TEST_F(SpaceRows, FurtherAnchorsAreFurtherViews) {
  draw_row(6, [](int i) { return space_at(2.0 + kWide * i); });
  const Eigen::Vector3d middle = map_.T_map_vehicle(20).inverse() * Eigen::Vector3d(7.0, 6.0, 0.0);
  labels_[2].sightings.push_back({{0, map_.keyframes[20].t_ns, 1}, middle, 0.05});
  const auto found = rows();
  ASSERT_EQ(found.size(), 1U);
  std::size_t views = 0;
  for (const RowSpace& space : found[0].spaces) views += space.views.size();
  ASSERT_EQ(views, 7U);
  for (const RowSpace& space : found[0].spaces)
    if (space.views.size() == 2) {
      EXPECT_EQ(space.views[1].pose, 20);
      EXPECT_TRUE(space.views[1].T_vehicle_space.translation().isApprox(middle));
      EXPECT_EQ(space.views[1].sigma_m, 0.05);
      EXPECT_LE(space.views[1].sigma_rad, 0.0);  // its heading is not known
    }
}

TEST_F(SpaceRows, OptionsOutOfTheirRangeAreNamed) {
  EXPECT_THROW((void)space_rows(map_, labels_, {.min_spaces = 2}), InvalidOption);
  EXPECT_THROW((void)space_rows(map_, labels_, {.min_share = 1.5}), InvalidOption);
}

}  // namespace
}  // namespace roadbook
