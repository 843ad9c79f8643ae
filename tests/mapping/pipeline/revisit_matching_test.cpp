#include "mapping/pipeline/revisit_matching.hpp"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

// Corners around a circle that a car with four fisheyes drives twice. Each lap has tracks of its
// own, as odometry gives them.
struct TwoLaps {
  MappingInput input;
  std::vector<Eigen::Isometry3d> poses;
  std::vector<std::vector<std::vector<int>>> corner;  ///< keyframe, camera, feature
  std::map<int, int> corner_of_track;
};

constexpr double kRadius = 8.0;
constexpr int kWholeLap = 50;  // keyframes, one each metre
constexpr int kSteps = 44;     // of a lap that ends 6 m before its start

TwoLaps drive_two_laps(double second_lap_offset_m) {
  Random random(4);
  TwoLaps laps;
  const Rig rig = test::fisheye_rig();
  const auto corners = test::corners_around(18.0, 900, random);
  laps.input.half_rigs = {rig};
  laps.input.has_wheels = {true};
  for (int k = 0; k < 2 * kSteps; ++k) {
    const double radius = k < kSteps ? kRadius : kRadius + second_lap_offset_m;
    const double angle = 2.0 * std::numbers::pi * (k % kSteps) / kWholeLap;
    laps.poses.push_back(test::on_circle(radius, radius * angle));
    auto view = test::view_from(laps.poses.back(), rig, corners, 15.0, 0.3, random);
    VoKeyframe keyframe;
    keyframe.t_ns = k * 100'000'000LL;
    keyframe.T_odom_vehicle = laps.poses.back();
    keyframe.travelled_m = k;
    for (const auto& list : view.corner) keyframe.tracks.emplace_back(list.size(), -1);
    keyframe.features = std::move(view.features);
    laps.input.odometry.keyframes.push_back(std::move(keyframe));
    laps.input.session.push_back(0);
    laps.corner.push_back(std::move(view.corner));
  }
  return laps;
}

// One track for each corner, camera and lap.
void link_tracks(TwoLaps& laps) {
  std::map<std::tuple<int, int, int>, int> ids;
  auto& odometry = laps.input.odometry;
  for (int k = 0; k < 2 * kSteps; ++k)
    for (int c = 0; c < 4; ++c) {
      const auto& seen = laps.corner[static_cast<std::size_t>(k)][static_cast<std::size_t>(c)];
      for (int f = 0; f < static_cast<int>(seen.size()); ++f) {
        const int corner = seen[static_cast<std::size_t>(f)];
        const auto [at, is_new] =
            ids.emplace(std::tuple(corner, c, k / kSteps), static_cast<int>(ids.size()));
        if (is_new) odometry.tracks.push_back({c, {}, {}});
        odometry.tracks[static_cast<std::size_t>(at->second)].observations.push_back({k, f});
        odometry.keyframes[static_cast<std::size_t>(k)]
            .tracks[static_cast<std::size_t>(c)][static_cast<std::size_t>(f)] = at->second;
        laps.corner_of_track[at->second] = corner;
      }
    }
}

int corner_at(const TwoLaps& laps, const KeyPointId& view) {
  return laps.corner[static_cast<std::size_t>(view.keyframe)][static_cast<std::size_t>(view.camera)]
                    [static_cast<std::size_t>(view.feature)];
}

TEST(RevisitMatching, TheSecondLapFindsTheCornersOfTheFirst) {
  TwoLaps laps = drive_two_laps(0.5);
  link_tracks(laps);
  const auto same = match_revisits(laps.input, laps.poses, std::vector<int>(2 * kSteps, 0), {});
  std::size_t right = 0;
  for (const TrackMatch& match : same) {
    EXPECT_GE(match.view.keyframe, kSteps);
    EXPECT_LT(laps.input.odometry.tracks[static_cast<std::size_t>(match.track)]
                  .observations.front()
                  .keyframe,
              kSteps);
    right += laps.corner_of_track.at(match.track) == corner_at(laps, match.view);
  }
  std::size_t seen = 0;
  for (int k = kSteps; k < 2 * kSteps; ++k)
    for (const auto& list : laps.corner[static_cast<std::size_t>(k)]) seen += list.size();
  // Descriptors of the corners are random, and differ by up to 40 bits from view to view.
  EXPECT_GE(right, same.size() * 995 / 1000);
  EXPECT_GT(right, seen / 2);
  // All four cameras take part.
  std::map<int, int> by_camera;
  for (const TrackMatch& match : same) ++by_camera[match.view.camera];
  EXPECT_EQ(by_camera.size(), 4U);
}

TEST(RevisitMatching, PosesTooFarApartOrOfAnotherPartAreNotCompared) {
  TwoLaps far = drive_two_laps(4.0);
  link_tracks(far);
  EXPECT_TRUE(match_revisits(far.input, far.poses, std::vector<int>(2 * kSteps, 0), {}).empty());
  TwoLaps apart = drive_two_laps(0.5);
  link_tracks(apart);
  std::vector<int> component(2 * kSteps, 0);
  std::fill(component.begin() + kSteps, component.end(), 1);
  EXPECT_TRUE(match_revisits(apart.input, apart.poses, component, {}).empty());
}

}  // namespace
}  // namespace roadbook
