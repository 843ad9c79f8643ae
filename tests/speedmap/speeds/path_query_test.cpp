#include "speedmap/speeds/path_query.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "tests/speedmap/small_property_map.hpp"

namespace roadbook {
namespace {

// A ring of 20 m radius with friction and presence that vary over it.
class Query : public ::testing::Test {
 protected:
  static LanePath ring() {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 200; ++i) {
      const double a = 2.0 * M_PI * i / 200;
      points.emplace_back(20.0 * std::cos(a), 20.0 * std::sin(a), 0.0);
    }
    PathFitOptions fit;
    fit.closed = true;
    fit.segments = 12;
    LanePath lane;
    lane.lane = 7;
    lane.path = fit_path(points, fit).path;
    lane.length_m = PathCurve(lane.path).length_m();
    lane.tube_m = 4.0;
    return lane;
  }
  static PropertyMapOptions as_given() {
    PropertyMapOptions options;
    options.prior_mean_sigma = 0.0;
    return options;
  }
  Query()
      : strips_({ring()}, 1.0, 2.0), friction_(strips_.knots(), test::small_prior(), as_given()) {
    options_.sight_m = 8.0;
    options_.motion = {4.0, 4.0, 6.0, 40.0};
    Random random(2, "labels");
    for (int i = 0; i < 4000; ++i)
      (void)friction_.add_label({random.uniform(0.0, 125.0), random.uniform(-4.0, 4.0)},
                                static_cast<int>(random.below(3)));
    profile_ = {7, 0.5, true, -1, -1, {}};
    const PathCurve& curve = strips_.strips()[0].frame.curve();
    const auto s = even_places(curve, 0.5);
    profile_.step_m = curve.length_m() / static_cast<double>(s.size());
    profile_.places = speed_limits_along(way_points(curve, s), s, 9.0, presence_, {}, options_);
    make_feasible(profile_.places, profile_.step_m, true, options_);
  }
  PresenceAt presence_ = [](const Eigen::Vector2d& p) {
    return std::optional(
        PresenceValue{0.4 + 0.3 * std::sin(0.7 * p.x()) * std::cos(0.9 * p.y()), 0.01});
  };
  LaneSpeedOptions options_;
  LaneStrips strips_;
  PropertyMap friction_;
  LaneProfile profile_;
};

TEST_F(Query, TellsSpeedFrictionLaneAndLabelsWithTheirGradients) {
  const LaneQuery query(
      strips_, profile_, presence_, [](const Eigen::Vector2d&) { return PlaceClass::kLane; },
      &friction_, options_);
  Random random(4, "query");
  std::map<SpeedLimitedBy, int> by;
  const double h = 1e-5;
  for (int k = 0; k < 2000; ++k) {
    const double s =
        random.uniform(0.0, profile_.step_m * static_cast<double>(profile_.places.size()));
    const double e = random.uniform(-3.9, 3.9);
    const auto at = query.at(s, e);
    ASSERT_TRUE(at);
    EXPECT_EQ(at->lane, 7U);
    EXPECT_EQ(at->place, PlaceClass::kLane);
    ASSERT_TRUE(at->presence && at->friction);
    EXPECT_EQ(at->ground_shares.size(), 3U);
    EXPECT_GE(at->speed.variance, 0.0);
    EXPECT_LE(at->speed.value, profile_.speed_at(s) + 1e-12);
    EXPECT_LE(
        at->speed.value,
        recommended_speed(at->presence->value, options_.min_speed, options_.max_speed) + 1e-12);
    ++by[at->limited_by];
    const auto along = [&](double ds, double de) { return query.at(s + ds, e + de); };
    const auto up_s = along(h, 0.0), down_s = along(-h, 0.0), up_e = along(0.0, h),
               down_e = along(0.0, -h);
    if (!up_s || !down_s || !up_e || !down_e) continue;
    const auto compare = [&](const auto& value, const Eigen::Vector2d& gradient) {
      EXPECT_NEAR((value(*up_s) - value(*down_s)) / (2.0 * h), gradient.x(), 1e-5);
      EXPECT_NEAR((value(*up_e) - value(*down_e)) / (2.0 * h), gradient.y(), 1e-5);
    };
    compare([](const PathAnswer& a) { return a.presence->value; }, at->presence->gradient);
    compare([](const PathAnswer& a) { return a.friction->mean; }, at->friction->d_mean);
    // Speed has kinks where another source takes over, and between places of the profile.
    const auto same = [&](const PathAnswer& a) { return a.limited_by == at->limited_by; };
    const double in_step = std::fmod(s, profile_.step_m) / profile_.step_m;
    if (same(*up_s) && same(*down_s) && same(*up_e) && same(*down_e) && in_step > 0.01 &&
        in_step < 0.99)
      compare([](const PathAnswer& a) { return a.speed.value; }, at->speed.gradient);
  }
  EXPECT_GT(by[SpeedLimitedBy::kLaw] + by[SpeedLimitedBy::kBend] + by[SpeedLimitedBy::kMotion],
            100);
  EXPECT_GT(by[SpeedLimitedBy::kPedestrian], 100);
  EXPECT_GT(by[SpeedLimitedBy::kGrip], 100);
}

// Occupancy and labels are functions of the plane. Along the bent lane their gradients change with
// the curvature.
TEST_F(Query, TellsOccupancyAndLabelsWithTheirGradients) {
  OccupancyCells cells;
  cells.low = {-26.0, -26.0};
  cells.cell_m = 0.5;
  cells.columns = cells.rows = 104;
  Random random(8, "cells");
  for (std::size_t i = 0; i < 104 * 104; ++i) {
    const bool unknown = i % 104 > 90;
    cells.probability.push_back(unknown ? NAN : static_cast<float>(random.uniform(0.1, 0.9)));
    cells.sigma.push_back(0.05F);
    cells.age_s.push_back(12.0F);
  }
  const OccupancyField occupancy(cells);
  const LabelField labels({{3, "parking_space", 0.2, {{16, 8}, {21, 8}, {21, 11}, {16, 11}}},
                           {{}, "crossing", NAN, {{-22, 0}, {-17, 0}, {-17, 3}, {-22, 3}}}});
  const LaneQuery query(strips_, profile_, presence_, {}, &friction_, options_, 1.0,
                        {&occupancy, &labels});
  constexpr double kStep = 1e-5;
  std::size_t known = 0, unknown = 0, near = 0;
  for (int k = 0; k < 3000; ++k) {
    const double s = random.uniform(0.0, 125.0);
    const double e = random.uniform(-3.9, 3.9);
    const auto at = query.at(s, e);
    ASSERT_TRUE(at && at->labels);
    const auto beside = [&](double ds, double de) { return query.at(s + ds, e + de); };
    const auto up_s = beside(kStep, 0.0), down_s = beside(-kStep, 0.0);
    const auto up_e = beside(0.0, kStep), down_e = beside(0.0, -kStep);
    ASSERT_TRUE(up_s && down_s && up_e && down_e);
    ++(at->occupancy ? known : unknown);
    const auto compare = [&](const auto& value, const Eigen::Vector2d& gradient) {
      EXPECT_NEAR((value(*up_s) - value(*down_s)) / (2.0 * kStep), gradient.x(), 1e-6);
      EXPECT_NEAR((value(*up_e) - value(*down_e)) / (2.0 * kStep), gradient.y(), 1e-6);
    };
    // Second derivatives jump at the middles of cells.
    const Eigen::Array2d share = (at->position - cells.low).array() / cells.cell_m - 0.5;
    const bool smooth = ((share - share.round()).abs() > 1e-3).all();
    if (smooth && at->occupancy && up_s->occupancy && down_s->occupancy && up_e->occupancy &&
        down_e->occupancy)
      compare([](const PathAnswer& a) { return a.occupancy->probability.value; },
              at->occupancy->probability.gradient);
    if (at->occupancy) {
      EXPECT_NEAR(at->occupancy->probability.variance, 0.0025, 1e-9);
      EXPECT_EQ(at->occupancy->age_s, 12.0);
    }
    if (at->labels->size() != 1) continue;
    const LabelNearby& label = at->labels->front();
    ++near;
    EXPECT_EQ(std::isnan(label.distance.variance), label.label->kind == "crossing");
    EXPECT_EQ(label.label->id.has_value(), label.label->kind == "parking_space");
    // Within a label the nearest edge changes on the diagonals.
    if (label.distance.value > 0.0)
      compare([](const PathAnswer& a) { return a.labels->front().distance.value; },
              label.distance.gradient);
  }
  EXPECT_GT(known, 1500U);
  EXPECT_GT(unknown, 100U);
  EXPECT_GT(near, 300U);
  const auto without = LaneQuery(strips_, profile_, presence_, {}, &friction_, options_).at(5.0, 0);
  EXPECT_FALSE(without->occupancy);
  EXPECT_FALSE(without->labels);
}

TEST_F(Query, HasNoSeamAndNothingOutside) {
  const LaneQuery query(strips_, profile_, presence_, {}, &friction_, options_);
  const double length = strips_.strips()[0].length_m();
  const auto before = query.at(length - 1e-9, 1.0);
  const auto after = query.at(0.0, 1.0);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(before->friction->mean, after->friction->mean, 1e-7);
  EXPECT_NEAR(before->presence->value, after->presence->value, 1e-7);
  EXPECT_LT((before->friction->d_mean - after->friction->d_mean).norm(), 1e-7);
  EXPECT_FALSE(query.at(3.0, 4.5));
  EXPECT_FALSE(query.at(NAN, 0.0));
}

// A lane that is a ring within a longer property map gives the same values as a separate map of
// this ring.
TEST_F(Query, ARingAmongOtherStripsIsAsClosedAsOneAlone) {
  LanePath other = ring();
  other.lane = 8;
  other.path.closed = true;
  const LaneStrips two({ring(), other}, 1.0, 2.0);
  KnotGridOptions grid;
  grid.length_m = strips_.strips()[0].length_m();
  grid.closed = true;
  grid.e_min_m = -4.0;
  grid.e_max_m = 4.0;
  PropertyMap alone(Knots::grid(grid), test::small_prior());
  PropertyMap both(two.knots(), test::small_prior());
  const double begin = two.strips()[1].begin_m;
  Random random(6, "ring");
  for (int i = 0; i < 2000; ++i) {
    const PathPlace v{random.uniform(0.0, grid.length_m), random.uniform(-4.0, 4.0)};
    const int label = static_cast<int>(random.below(3));
    ASSERT_TRUE(alone.add_label(v, label));
    ASSERT_TRUE(both.add_label({begin + v.s_m, v.e_m}, label));
  }
  for (const double s : {0.0, 0.3, 50.0, grid.length_m - 0.4}) {
    const auto a = alone.moments(0, {s, 0.7});
    const auto b = both.moments(0, {begin + s, 0.7});
    ASSERT_TRUE(a && b);
    EXPECT_NEAR(a->mean, b->mean, 1e-12) << s;
    EXPECT_NEAR(a->variance, b->variance, 1e-12) << s;
  }
}

}  // namespace
}  // namespace roadbook
