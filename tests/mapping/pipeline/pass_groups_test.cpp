#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "mapping/pipeline/bundle_problem.hpp"
#include "mapping/pipeline/pass_numbers.hpp"
#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

constexpr int kLapCount = 11;
constexpr int kLapSteps = 50;  // keyframes of a lap, one each metre
constexpr double kRing_m = 8.0;

// A car with four fisheyes that drives round a ring; every corner is one track over all laps.
struct ManyLaps {
  MappingInput input;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<JoinedTrack> tracks;
};

ManyLaps drive_many_laps() {
  Random random(7);
  ManyLaps laps;
  const Rig rig = test::fisheye_rig();
  const auto corners = test::corners_around(18.0, 500, random);
  laps.input.half_rigs = {rig};
  laps.input.has_wheels = {true};
  std::map<std::pair<int, std::size_t>, JoinedTrack> by_corner;
  for (int k = 0; k < kLapCount * kLapSteps; ++k) {
    const double radius = kRing_m + random.normal(0.0, 0.2);
    laps.poses.push_back(test::on_circle(radius, radius * 2.0 * std::numbers::pi * k / kLapSteps));
    auto view = test::view_from(laps.poses.back(), rig, corners, 9.0, 0.3, random);
    for (std::size_t c = 0; c < view.corner.size(); ++c)
      for (std::size_t f = 0; f < view.corner[c].size(); ++f) {
        const int corner = view.corner[c][f];
        JoinedTrack& track = by_corner[{corner, c}];
        track.p_map = corners[static_cast<std::size_t>(corner)].p_world;
        track.revisited = true;
        track.views.push_back({k, static_cast<int>(c), static_cast<int>(f)});
      }
    VoKeyframe keyframe;
    keyframe.t_ns = k * 500'000'000LL;
    keyframe.T_odom_vehicle = laps.poses.back();
    keyframe.travelled_m = k;
    keyframe.features = std::move(view.features);
    laps.input.odometry.keyframes.push_back(std::move(keyframe));
    laps.input.session.push_back(0);
  }
  for (auto& [corner, track] : by_corner) laps.tracks.push_back(std::move(track));
  return laps;
}

int lap_of(int keyframe) { return keyframe / kLapSteps; }

// ManyLaps that see each point.
std::vector<std::set<int>> laps_of_points(const BundleStage& stage) {
  std::vector<std::set<int>> laps(stage.problem.points.size());
  for (const BundleObservation& o : stage.problem.observations)
    laps[static_cast<std::size_t>(o.point)].insert(lap_of(o.pose));
  return laps;
}

std::vector<int> numbers_of(const ManyLaps& laps) {
  const std::size_t count = laps.poses.size();
  return pass_numbers(laps.input, laps.poses, std::vector<int>(count, 0),
                      std::vector<bool>(count, true), {});
}

TEST(PassNumbers, CountTheLapsOfARing) {
  const ManyLaps laps = drive_many_laps();
  const std::vector<int> number = numbers_of(laps);
  for (int k = 0; k < kLapCount * kLapSteps; ++k) {
    const int lap = lap_of(k);
    // Shortly before its end a lap meets the beginning of the first one.
    const int most = k % kLapSteps < kLapSteps - 4 ? lap : lap + 1;
    EXPECT_GE(number[static_cast<std::size_t>(k)], lap) << k;
    EXPECT_LE(number[static_cast<std::size_t>(k)], most) << k;
  }
}

TEST(PassNumbers, OfTheOppositeDirectionAreOfAnotherPlace) {
  ManyLaps laps = drive_many_laps();
  for (int k = kLapSteps; k < 2 * kLapSteps; ++k)
    laps.poses[static_cast<std::size_t>(k)].linear() =
        laps.poses[static_cast<std::size_t>(k)].linear() *
        Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const std::vector<int> number = numbers_of(laps);
  EXPECT_EQ(number[kLapSteps + 20], 0);
  EXPECT_EQ(number[2 * kLapSteps + 20], 1);
}

TEST(PassGroups, CoupleFourPassesAtMostAndLeaveNoneOut) {
  const ManyLaps laps = drive_many_laps();
  const BundleStage stage = make_bundle(laps.input, laps.poses, laps.tracks, {});
  const auto seen = laps_of_points(stage);
  // At the seam of the laps a group may begin one lap earlier and end one lap later.
  for (const std::set<int>& laps_of_point : seen)
    EXPECT_LE(*laps_of_point.rbegin() - *laps_of_point.begin(), 5);
  for (int lap = 1; lap < kLapCount; ++lap)
    EXPECT_GT(std::count_if(
                  seen.begin(), seen.end(),
                  [&](const std::set<int>& s) { return s.contains(lap) && s.contains(lap - 1); }),
              20)
        << lap;
  std::map<int, int> views;
  for (const BundleObservation& o : stage.problem.observations) ++views[o.pose];
  for (int k = 0; k < kLapCount * kLapSteps; ++k) EXPECT_GE(views[k], 20) << k;
  // The points of a track are one corner.
  for (std::size_t p = 1; p < stage.problem.points.size(); ++p)
    EXPECT_EQ(stage.track_of_point[p] == stage.track_of_point[p - 1],
              stage.problem.points[p].corner == stage.problem.points[p - 1].corner)
        << p;
  EXPECT_TRUE(std::is_sorted(stage.track_of_point.begin(), stage.track_of_point.end()));
}

// The first group keeps the long reach, which a place with few passes needs.
TEST(PassGroups, AfterTheFirstGroupPointsHaveViewsOfFewerKeyframes) {
  ManyLaps laps = drive_many_laps();
  const auto is_seen = [](int keyframe) {
    return keyframe % kLapSteps >= 10 && keyframe % kLapSteps < 28;
  };
  for (JoinedTrack& track : laps.tracks)
    std::erase_if(track.views, [&](const KeyPointId& v) { return !is_seen(v.keyframe); });
  BundleStageOptions options;
  options.reach_of_many_passes = 3;
  const BundleStage stage = make_bundle(laps.input, laps.poses, laps.tracks, options);
  std::map<std::pair<int, int>, std::pair<int, int>> seen;  // of (point, lap): first, last keyframe
  for (const BundleObservation& o : stage.problem.observations) {
    auto& [first, last] =
        seen.try_emplace({o.point, lap_of(o.pose)}, std::pair(o.pose, o.pose)).first->second;
    first = std::min(first, o.pose);
    last = std::max(last, o.pose);
  }
  std::map<int, int> longest;  // of each lap
  for (const auto& [key, ends] : seen)
    longest[key.second] = std::max(longest[key.second], ends.second - ends.first);
  for (const int lap : {0, 1, 2}) EXPECT_GT(longest[lap], 12) << lap;
  for (int lap = 4; lap < kLapCount; ++lap) EXPECT_LE(longest[lap], 6) << lap;
}

// The fourth lap is dark and finds no corner again: the fifth takes its place in the groups.
TEST(PassGroups, TieLapsAcrossOneThatSawNothing) {
  ManyLaps laps = drive_many_laps();
  for (JoinedTrack& track : laps.tracks)
    std::erase_if(track.views, [](const KeyPointId& v) { return lap_of(v.keyframe) == 3; });
  const BundleStage stage = make_bundle(laps.input, laps.poses, laps.tracks, {});
  const auto seen = laps_of_points(stage);
  const auto holds = [&](int earlier, int later) {
    return std::count_if(seen.begin(), seen.end(), [&](const std::set<int>& s) {
      return s.contains(earlier) && s.contains(later);
    });
  };
  EXPECT_GT(holds(2, 4), 100);
  EXPECT_GT(holds(4, 5), 100);
}

// Two places of the same coordinates that nothing joins: six laps each are passes 0 to 5 of each.
TEST(PassGroups, OfPiecesThatLieOnEachOtherCountApart) {
  ManyLaps laps = drive_many_laps();
  constexpr int kFirst = 6 * kLapSteps;
  laps.input.odometry.keyframes[kFirst].after_gap = true;
  std::vector<JoinedTrack> parts;
  for (const JoinedTrack& track : laps.tracks)
    for (const bool later : {false, true}) {
      JoinedTrack part = track;
      std::erase_if(part.views,
                    [&](const KeyPointId& v) { return (v.keyframe >= kFirst) != later; });
      if (part.views.size() > 1) parts.push_back(std::move(part));
    }
  const BundleStage stage = make_bundle(laps.input, laps.poses, parts, {});
  const auto seen = laps_of_points(stage);
  // Laps 6 to 9 are one group of their piece; counted together they would be in two.
  EXPECT_TRUE(std::any_of(seen.begin(), seen.end(), [](const std::set<int>& s) {
    return s == std::set<int>{6, 7, 8, 9};
  }));
}

TEST(PassGroups, TakeAllPassesTogetherWhereTheyAreAsked) {
  const ManyLaps laps = drive_many_laps();
  BundleStageOptions options;
  options.passes_together = 0;
  const BundleStage stage = make_bundle(laps.input, laps.poses, laps.tracks, options);
  const auto seen = laps_of_points(stage);
  EXPECT_GT(
      std::count_if(seen.begin(), seen.end(),
                    [](const std::set<int>& s) { return static_cast<int>(s.size()) == kLapCount; }),
      50);
}

TEST(PassGroups, ATracksPlaceIsTheMeanOfItsPointsByTheirViews) {
  BundleStage stage;
  stage.track_of_point = {0, 0, 2};
  stage.problem.points.resize(3);
  stage.problem.points[0].p_map = {1.0, 0.0, 0.0};
  stage.problem.points[1].p_map = {5.0, 0.0, 0.0};
  stage.problem.points[2].p_map = {7.0, 0.0, 0.0};
  for (const int point : {0, 0, 0, 1, 2, 2}) {
    BundleObservation o;
    o.point = point;
    stage.problem.observations.push_back(o);
  }
  auto places = adjusted_places(stage, {1, 1, 1}, 3);
  EXPECT_NEAR(places[0]->x(), 2.0, 1e-12);
  EXPECT_FALSE(places[1]);
  EXPECT_EQ(places[2]->x(), 7.0);
  places = adjusted_places(stage, {0, 1, 0}, 3);
  EXPECT_EQ(places[0]->x(), 5.0);
  EXPECT_FALSE(places[2]);
}

}  // namespace
}  // namespace roadbook
