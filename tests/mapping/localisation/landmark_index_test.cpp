#include "mapping/localisation/landmark_index.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mapping/landmark_descriptor.hpp"
#include "tests/mapping/localisation/synthetic_place.hpp"

namespace roadbook {
namespace {

// Two sessions side by side: each pose of either sees the landmark with the same number.
Map two_sessions() {
  Map map;
  for (const char* name : {"monday", "tuesday"}) {
    Session session;
    session.name = name;
    session.rig = test::fisheye_rig();
    map.sessions.push_back(session);
  }
  for (int k = 0; k < 20; ++k) {
    Keyframe keyframe;
    keyframe.session = k / 10;
    keyframe.map_frame = k;
    map.map_frames.push_back({pose_from_planar(2.0 * (k % 10), k < 10 ? 0.0 : 1.0, 0.0)});
    map.keyframes.push_back(keyframe);
    Landmark landmark;
    landmark.map_frame = k;
    landmark.p_frame = {8.0, 0.0, 1.0};
    map.landmarks.push_back(landmark);
    map.observations.push_back({k, k, 0, {320.0F, 240.0F}, 1.0F});
  }
  return map;
}

TEST(LandmarkIndex, FetchesWhatNearbyPosesSaw) {
  const Map map = two_sessions();
  const LandmarkIndex index(map);
  NearLandmarksOptions options;
  options.reach_m = 2.5;
  EXPECT_EQ(index.near(pose_from_planar(4.0, 0.0, 0.0), options),
            (std::vector<int>{1, 2, 3, 11, 12, 13}));
  options.max_landmarks = 50;
  EXPECT_TRUE(index.near(pose_from_planar(60.0, 0.0, 0.0), options).empty());
  EXPECT_EQ(index.nearest_keyframe({4.1, 0.2, 0.0}), 2);
  EXPECT_EQ(index.nearest_keyframe({30.0, 1.0, 0.0}), 19);
  EXPECT_EQ(index.nearest_keyframe({300.0, 0.0, 0.0}), -1);
  EXPECT_EQ(index.seen_from(3), std::vector<int>{3});
  EXPECT_EQ(index.viewers(13), std::vector<int>{13});
}

// No session has seen the landmark from behind.
TEST(LandmarkIndex, LeavesOutWhatWasSeenFromTheOtherSideOrFromFarAway) {
  const Map map = two_sessions();
  const LandmarkIndex index(map);
  NearLandmarksOptions options;
  options.reach_m = 40.0;
  const auto behind = index.near(pose_from_planar(16.0, 0.0, 0.0), options);
  EXPECT_FALSE(std::count(behind.begin(), behind.end(), 0)) << "seen from 8 m before it alone";
  const auto before = index.near(pose_from_planar(1.0, 0.0, 0.0), options);
  EXPECT_TRUE(std::count(before.begin(), before.end(), 0));
  EXPECT_FALSE(std::count(before.begin(), before.end(), 9)) << "25 m away, seen from 7 m";
}

TEST(LandmarkIndex, ASessionCountsAlone) {
  const Map map = two_sessions();
  const LandmarkIndex index(map, {"tuesday"});
  EXPECT_EQ(index.nearest_keyframe({4.0, 0.0, 0.0}), 12);
  EXPECT_FALSE(index.landmarks()[2].used);
  EXPECT_TRUE(index.landmarks()[12].used);
  EXPECT_THROW(LandmarkIndex(map, {"sunday"}), InvalidOption);
}

// The covariance of a landmark is stored in the axes of its map frame.
TEST(LandmarkIndex, TurnsCovariancesIntoTheMap) {
  Map map = two_sessions();
  map.map_frames[0].T_map_frame = pose_from_planar(0.0, 0.0, 1.5707963267948966);
  map.landmarks[0].covariance = Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal();
  const LandmarkIndex index(map);
  EXPECT_TRUE(index.landmarks()[0].covariance.isApprox(
      Eigen::Matrix3d(Eigen::Vector3d(4.0, 1.0, 9.0).asDiagonal()), 1e-9));
  EXPECT_TRUE(is_known(index.landmarks()[1].covariance)) << "unknown in the map";
}

TEST(LandmarkDescriptor, IsTheOneMostLikeAllOthers) {
  Random random(1, "middle descriptor");
  const Descriptor middle = test::random_descriptor(random);
  std::vector<Descriptor> seen;
  for (int i = 0; i < 6; ++i) seen.push_back(test::with_flipped_bits(middle, 60, random));
  seen.insert(seen.begin() + 4, middle);
  EXPECT_EQ(middle_descriptor(seen), 4U);
  EXPECT_EQ(middle_descriptor(std::vector<Descriptor>{middle, middle}), 0U);
}

}  // namespace
}  // namespace roadbook
