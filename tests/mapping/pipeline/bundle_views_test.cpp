#include "mapping/pipeline/bundle_views.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

constexpr double kCircleRadius = 8.0;
constexpr int kStepsOfLap = 50;  // keyframes, one each metre

struct Laps {
  MappingInput input;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<JoinedTrack> tracks;  // one for each corner and camera, with the views of all laps
};

// Laps of one circle, each a little farther to the side.
Laps drive_circle(int laps) {
  Random random(4);
  Laps drive;
  const Rig rig = test::fisheye_rig();
  const auto corners = test::corners_around(18.0, 900, random);
  drive.input.half_rigs = {rig};
  drive.input.has_wheels = {true};
  std::map<std::pair<int, int>, JoinedTrack> tracks;
  for (int k = 0; k < laps * kStepsOfLap; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k % kStepsOfLap) / kStepsOfLap;
    const double radius = kCircleRadius + 0.1 * (k / kStepsOfLap % 3);
    drive.poses.push_back(test::on_circle(radius, radius * angle));
    auto view = test::view_from(drive.poses.back(), rig, corners, 15.0, 0.3, random);
    for (std::size_t c = 0; c < view.corner.size(); ++c)
      for (std::size_t f = 0; f < view.corner[c].size(); ++f) {
        JoinedTrack& track = tracks[{view.corner[c][f], static_cast<int>(c)}];
        track.p_map = corners[static_cast<std::size_t>(view.corner[c][f])].p_world;
        track.revisited = laps > 1;
        track.views.push_back({k, static_cast<int>(c), static_cast<int>(f)});
      }
    VoKeyframe keyframe;
    keyframe.features = std::move(view.features);
    keyframe.T_odom_vehicle = drive.poses.back();
    drive.input.odometry.keyframes.push_back(std::move(keyframe));
    drive.input.session.push_back(0);
  }
  for (auto& [key, track] : tracks)
    if (track.views.size() > 1) drive.tracks.push_back(std::move(track));
  return drive;
}

TEST(BundleViews, TheFirstPassesAreTheBaseAndTheNearestViewsOfAPassAreKept) {
  const Laps drive = drive_circle(5);
  const auto is_base = find_base_keyframes(drive.poses, 3);
  for (std::size_t k = 0; k < is_base.size(); ++k) {
    const auto lap = k / kStepsOfLap;
    const auto step = k % kStepsOfLap;
    if (step < 3 || step + 3 > kStepsOfLap) continue;  // the seam is passed at both ends of a lap
    if (lap < 3) {
      EXPECT_EQ(is_base[k], 1) << k;
    }
    if (lap > 3) {
      EXPECT_EQ(is_base[k], 0) << k;
    }
  }
  for (const JoinedTrack& track : drive.tracks)
    for (const CornerPass& pass : passes_of(track, drive.poses, 8))
      for (const KeyPointId& view : pass.views)
        EXPECT_LE(std::abs(view.keyframe - pass.nearest), 8);
}

}  // namespace
}  // namespace roadbook
