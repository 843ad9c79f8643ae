#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "workflows/compare/lane_overlap.hpp"
#include "workflows/compare/map_comparison.hpp"

namespace roadbook {
namespace {

constexpr int kViews = 4;  // landmarks that each pose sees, its own

Eigen::Isometry3d known_motion() {
  Vector6d xi;
  xi << 30.0, -12.0, 4.0, 0.3, -0.2, 1.1;
  return se3_exp(xi);
}

// Poses at the given places, all headings the same; each sees four landmarks of its own.
Map map_of(const std::vector<Eigen::Vector3d>& places, const Eigen::Isometry3d& T) {
  Map map;
  map.sessions.resize(1);
  map.sessions[0].name = "monday";
  map.sessions[0].drive_digest = "digest of monday";
  map.map_frames.resize(1);
  for (const Eigen::Vector3d& place : places) {
    const auto k = static_cast<int>(map.keyframes.size());
    Keyframe keyframe;
    keyframe.t_ns = 1'700'000'000'000'000'000 + k * std::int64_t{100'000'000};
    keyframe.T_frame_vehicle = T * Eigen::Isometry3d(Eigen::Translation3d(place));
    map.keyframes.push_back(keyframe);
    for (int i = 0; i < kViews; ++i) {
      Landmark landmark;
      landmark.p_frame = T * Eigen::Vector3d(3.0 * k, 2.0 * i, 1.0);
      landmark.covariance = 1e-4 * Eigen::Matrix3d::Identity();
      Observation o;
      o.landmark = static_cast<int>(map.landmarks.size());
      o.keyframe = k;
      o.pixel = {100.0F + 10.0F * static_cast<float>(i), 50.0F};
      map.landmarks.push_back(landmark);
      map.observations.push_back(o);
    }
  }
  return map;
}

// Points on the axes about their mean, which is the origin.
std::vector<Eigen::Vector3d> cross() {
  return {{10, 0, 0}, {-10, 0, 0}, {0, 6, 0}, {0, -6, 0}, {0, 0, 2}, {0, 0, -2}};
}

void add_loop(Map& map, int from, int to, bool accepted = true) {
  LoopEdge loop;
  loop.from = from;
  loop.to = to;
  loop.accepted = accepted;
  map.loops.push_back(loop);
}

TEST(CompareMaps, AMapIsItself) {
  Map map = map_of(cross(), Eigen::Isometry3d::Identity());
  add_loop(map, 0, 4);
  const MapComparison c = compare_maps(map, map);
  EXPECT_EQ(c.common_sessions, std::vector<std::string>{"monday"});
  EXPECT_TRUE(c.sessions_only_a.empty());
  EXPECT_TRUE(c.sessions_only_b.empty());
  ASSERT_EQ(c.poses.size(), 6U);
  EXPECT_NEAR(*c.median_m, 0.0, 1e-12);
  EXPECT_NEAR(c.poses[*c.worst].distance_m, 0.0, 1e-12);
  EXPECT_EQ(c.landmarks.both, 24U);
  EXPECT_EQ(c.landmarks.judged, 24U);
  EXPECT_EQ(c.landmarks.only_a, 0U);
  EXPECT_EQ(c.landmarks.only_b, 0U);
  EXPECT_EQ(c.landmarks.moved, 0U);
  EXPECT_EQ(c.loops.both, 1U);
  EXPECT_EQ(c.loops.only_a + c.loops.only_b, 0U);
}

// A stretch along the axes of the cross leaves the best motion as it is: no rotation brings the
// points nearer. The distances are the stretch times the arms.
TEST(CompareMaps, FindsTheMotionAndTheDistancesThatItLeaves) {
  std::vector<Eigen::Vector3d> stretched = cross();
  for (Eigen::Vector3d& p : stretched) p = Eigen::Vector3d(1.01, 1.05, 1.2).cwiseProduct(p);
  const Map a = map_of(cross(), Eigen::Isometry3d::Identity());
  const Map b = map_of(stretched, known_motion());
  const MapComparison c = compare_maps(a, b);
  ASSERT_TRUE(c.T_a_b.has_value());
  EXPECT_TRUE(c.T_a_b->isApprox(known_motion().inverse(), 1e-9));
  const std::vector<double> distances{0.1, 0.1, 0.3, 0.3, 0.4, 0.4};
  for (std::size_t i = 0; i < distances.size(); ++i) {
    EXPECT_NEAR(c.poses[i].distance_m, distances[i], 1e-9) << i;
    EXPECT_NEAR(c.poses[i].angle_rad, 0.0, 1e-7) << i;
  }
  EXPECT_NEAR(*c.median_m, 0.3, 1e-9);
  EXPECT_NEAR(*c.p95_m, 0.4, 1e-9);
  EXPECT_GE(c.poses[*c.worst].a, 4);
  EXPECT_NEAR(*c.landmarks.median_m, 0.0, 1e-9);
}

// On a straight line positions alone leave the roll open.
TEST(CompareMaps, AStraightRoadLeavesNoRotationOpen) {
  const std::vector<Eigen::Vector3d> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {5, 0, 0}};
  const MapComparison c =
      compare_maps(map_of(line, Eigen::Isometry3d::Identity()), map_of(line, known_motion()));
  EXPECT_TRUE(c.T_a_b->isApprox(known_motion().inverse(), 1e-9));
  EXPECT_NEAR(*c.landmarks.median_m, 0.0, 1e-9);
}

TEST(CompareMaps, CountsLandmarksThatAreGoneNewMovedOrNotKnown) {
  const Map a = map_of(cross(), Eigen::Isometry3d::Identity());
  Map b = map_of(cross(), known_motion());
  // Of both maps' 24: one is seen elsewhere in the image, one at the edge of the same corner.
  b.observations[0].pixel.x() += 0.6F;
  b.observations[1].pixel.x() += 0.4F;
  // sigma of the difference: sqrt(2) cm; the limit is 3 sigma + 5 cm = 9.24 cm.
  b.landmarks[5].p_frame.z() += 0.10;
  b.landmarks[6].p_frame.x() += 0.09;
  b.landmarks[7].covariance = unknown_covariance<Eigen::Matrix3d>();
  b.landmarks[7].p_frame.z() += 5.0;
  b.landmarks.push_back(b.landmarks[8]);  // without observations
  const MapComparison c = compare_maps(a, b);
  EXPECT_EQ(c.landmarks.both, 23U);
  EXPECT_EQ(c.landmarks.only_a, 1U);
  EXPECT_EQ(c.landmarks.only_b, 2U);
  EXPECT_EQ(c.landmarks.compared, 23U);
  EXPECT_EQ(c.landmarks.judged, 22U);
  EXPECT_EQ(c.landmarks.moved, 1U);
  EXPECT_EQ(c.landmarks.ids_only_a, std::vector<int>{0});
  EXPECT_EQ(c.landmarks.ids_only_b, (std::vector<int>{0, 24}));
  EXPECT_EQ(c.landmarks.moved_ids, (std::vector<std::pair<int, int>>{{5, 5}}));
}

TEST(CompareMaps, ALandmarkBelongsToTheOneItSharesMostViewsWith) {
  Map a = map_of(cross(), Eigen::Isometry3d::Identity());
  Map b = a;
  // Landmark 0 of A is seen from pose 1, too, where B sees landmarks 0 and 23 at one corner.
  Observation o = a.observations[0];
  o.keyframe = 1;
  o.pixel = {400.0F, 300.0F};
  a.observations.push_back(o);
  b.observations.push_back(o);
  o.landmark = 23;
  b.observations.push_back(o);
  const MapComparison c = compare_maps(a, b);
  EXPECT_EQ(c.landmarks.both, 24U);
  EXPECT_NEAR(*c.landmarks.median_m, 0.0, 1e-9);
  EXPECT_EQ(c.landmarks.moved, 0U);
}

TEST(CompareMaps, CountsAcceptedLoopsWhicheverEndIsFirst) {
  Map a = map_of(cross(), Eigen::Isometry3d::Identity());
  Map b = a;
  add_loop(a, 0, 4);
  add_loop(a, 1, 5);
  add_loop(a, 2, 5, false);
  add_loop(b, 4, 0);
  add_loop(b, 2, 5);
  add_loop(b, 1, 4);
  add_loop(b, 1, 5, false);
  const MapComparison c = compare_maps(a, b);
  EXPECT_EQ(c.loops.both, 1U);
  EXPECT_EQ(c.loops.only_a, 1U);
  EXPECT_EQ(c.loops.only_b, 2U);
}

TEST(CompareMaps, MapsOfOtherDrivesHaveNoNumbers) {
  const Map a = map_of(cross(), Eigen::Isometry3d::Identity());
  Map b = a;
  b.sessions[0].drive_digest = "another drive of that name";
  const MapComparison c = compare_maps(a, b);
  EXPECT_TRUE(c.common_sessions.empty());
  EXPECT_EQ(c.sessions_only_a, std::vector<std::string>{"monday"});
  EXPECT_EQ(c.sessions_only_b, std::vector<std::string>{"monday"});
  EXPECT_FALSE(c.T_a_b || c.median_m || c.p95_m || c.worst || c.landmarks.median_m);
  EXPECT_EQ(c.landmarks.only_a, 24U);
  EXPECT_EQ(c.landmarks.only_b, 24U);
  EXPECT_TRUE(compare_maps(Map{}, Map{}).poses.empty());
}

// A session is found by its drive, whatever its name and number; the larger piece is compared.
TEST(CompareMaps, FindsSessionsByDriveAndComparesTheLargestPiece) {
  const Map a = map_of(cross(), Eigen::Isometry3d::Identity());
  Map b = map_of(cross(), known_motion());
  Session tuesday = b.sessions[0];
  tuesday.drive_digest = "digest of tuesday";
  tuesday.name = "tuesday";
  b.sessions[0].name = "renamed";
  b.sessions.insert(b.sessions.begin(), tuesday);
  for (Keyframe& keyframe : b.keyframes) keyframe.session = 1;
  for (const std::size_t i : {4U, 5U}) {
    b.keyframes[i].piece = 1;
    b.keyframes[i].T_frame_vehicle.translation() += Eigen::Vector3d(100.0, 0.0, 0.0);
  }
  const MapComparison c = compare_maps(a, b);
  EXPECT_EQ(c.common_sessions, std::vector<std::string>{"monday"});
  EXPECT_EQ(c.sessions_only_b, std::vector<std::string>{"tuesday"});
  EXPECT_EQ(c.poses.size(), 4U);
  EXPECT_EQ(c.poses_of_other_pieces, 2U);
  EXPECT_NEAR(c.poses[*c.worst].distance_m, 0.0, 1e-9);
  EXPECT_EQ(c.landmarks.both, 24U);
  EXPECT_EQ(c.landmarks.compared, 16U);
}

TEST(LaneOverlap, IsTheShareOfTheLengthThatIsNear) {
  const std::vector<Polyline> road{{{0.0, 0.0}, {100.0, 0.0}}};
  const std::vector<Polyline> shifted{{{0.0, 0.4}, {100.0, 0.4}}};
  const std::vector<Polyline> far{{{0.0, 0.6}, {100.0, 0.6}}};
  const std::vector<Polyline> longer{{{0.0, 0.0}, {100.0, 0.0}, {100.0, 100.0}}};
  EXPECT_DOUBLE_EQ(total_length_m(longer), 200.0);
  EXPECT_DOUBLE_EQ(share_within(road, shifted, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(share_within(road, far, 0.5), 0.0);
  EXPECT_DOUBLE_EQ(share_within(road, longer, 0.5), 1.0);
  EXPECT_NEAR(share_within(longer, road, 0.5), 100.5 / 200.0, 0.1 / 200.0);
  // A crossing at 45 degrees is within 0.5 m over a length of 1 m / sin 45 degrees.
  const std::vector<Polyline> crossing{{{40.0, -10.0}, {60.0, 10.0}}};
  EXPECT_NEAR(share_within(crossing, road, 0.5), std::numbers::sqrt2 / (20.0 * std::numbers::sqrt2),
              0.2 / 28.0);
  EXPECT_DOUBLE_EQ(share_within({}, road, 0.5), 0.0);
  EXPECT_DOUBLE_EQ(share_within(road, {}, 0.5), 0.0);
}

}  // namespace
}  // namespace roadbook
