#include "mapping/sessions/stored_input.hpp"

#include <gtest/gtest.h>

#include <set>

#include "base/index.hpp"
#include "tests/mapping/localisation/synthetic_place.hpp"

// What a map stores must give the stages after odometry the same tracks as the recording did: each
// observation is a key point of the one track of its landmark.

namespace roadbook {
namespace {

TEST(StoredInput, HasEveryObservationInTheTrackOfItsLandmark) {
  const Map map = test::synthetic_place(5).map;
  const StoredInput stored = stored_input(map);
  const auto& odometry = stored.input.odometry;
  ASSERT_EQ(odometry.keyframes.size(), map.keyframes.size());
  std::vector<std::vector<int>> next(map.keyframes.size(), std::vector<int>(4, 0));
  for (const Observation& seen : map.observations) {
    const int feature = next[at(seen.keyframe)][at(seen.camera)]++;
    const KeyPointId view{seen.keyframe, seen.camera, feature};
    EXPECT_LT((full_size_pixel(stored.input.pixel(view)) - seen.pixel.cast<double>()).norm(), 1e-3);
    const int track = odometry.keyframes[at(seen.keyframe)].tracks[at(seen.camera)][at(feature)];
    ASSERT_GE(track, 0);
    EXPECT_EQ(stored.landmark_of_track[at(track)], seen.landmark);
    EXPECT_EQ(
        odometry.keyframes[at(seen.keyframe)].features[at(seen.camera)].descriptors[at(feature)],
        map.landmarks[at(seen.landmark)].descriptor);
  }
}

// Joined, the tracks of one landmark are one again, and triangulation finds it where it is: the
// pixels of this place have no noise.
TEST(StoredInput, JoinsToTheLandmarksOfTheMap) {
  const test::SyntheticPlace place = test::synthetic_place(5);
  const StoredInput stored = stored_input(place.map);
  auto tracks = join_tracks(stored.input.odometry, stored.same);
  std::set<int> seen;
  for (const Observation& o : place.map.observations) seen.insert(o.landmark);
  EXPECT_LE(tracks.size(), seen.size());
  EXPECT_GT(tracks.size(), 0.95 * static_cast<double>(seen.size()));  // of one view: no track
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t k = 0; k < place.map.keyframes.size(); ++k)
    poses.push_back(place.map.T_map_vehicle(static_cast<int>(k)));
  triangulate_tracks(stored.input, poses, {}, tracks);
  std::size_t found = 0;
  for (const JoinedTrack& track : tracks) {
    if (!track.p_map || track.views.size() < 6) continue;
    const KeyPointId& view = track.views.front();
    const int id = stored.input.odometry.keyframes[at(view.keyframe)]
                       .tracks[at(view.camera)][at(view.feature)];
    const int landmark = stored.landmark_of_track[at(id)];
    EXPECT_LT((*track.p_map - place.points[at(landmark)]).norm(), 0.01);
    ++found;
  }
  EXPECT_GT(found, tracks.size() / 2);
}

TEST(StoredInput, KeepsCornersWithoutALandmarkApart) {
  Map map = test::synthetic_place(5).map;
  Random random(3, "corner");
  map.corners.push_back({2, 1, {320.5F, 240.25F}, test::random_descriptor(random)});
  const StoredInput stored = stored_input(map);
  const VoKeyframe& keyframe = stored.input.odometry.keyframes[2];
  ASSERT_FALSE(keyframe.tracks[1].empty());
  EXPECT_EQ(keyframe.tracks[1].back(), -1);
  EXPECT_EQ(keyframe.features[1].descriptors.back(), map.corners.front().descriptor);
}

}  // namespace
}  // namespace roadbook
