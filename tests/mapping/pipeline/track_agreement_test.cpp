#include "mapping/pipeline/track_agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

constexpr int kVisitKeyframes = 30;  // keyframes of a session, every half metre on a circle
constexpr double kSigma_px = 0.25;

// What an odometry track shows.
struct TrackOf {
  int corner = 0;
  int session = 0;
  int camera = 0;
};

// Two sessions on one way see corners around it; each session has a track of each corner and
// camera.
class TwoSessionsOfCorners : public ::testing::Test {
 protected:
  void drive(double camera_error_rad = 0.0) {
    Random random(9);
    const Rig rig = test::fisheye_rig();
    Rig seen_by = rig;  // calibration that the map believes is wrong by a turn of camera 0
    seen_by.cameras[0].T_vehicle_camera.rotate(
        Eigen::AngleAxisd(camera_error_rad, Eigen::Vector3d::UnitY()));
    corners_ = test::corners_around(12.0, 160, random);
    input_.half_rigs = {rig, rig};
    input_.has_wheels = {true, true};
    std::map<std::tuple<int, int, int>, int> ids;  // corner, camera, session
    for (int k = 0; k < 2 * kVisitKeyframes; ++k) {
      poses_.push_back(
          test::on_circle(6.0, 0.5 * (k % kVisitKeyframes) + 0.1 * (k / kVisitKeyframes)));
      auto view = test::view_from(poses_.back(), seen_by, corners_, 12.0, kSigma_px, random);
      VoKeyframe keyframe;
      for (std::size_t c = 0; c < view.corner.size(); ++c) {
        auto& tracks = keyframe.tracks.emplace_back();
        for (std::size_t f = 0; f < view.corner[c].size(); ++f) {
          const auto [place, is_new] =
              ids.emplace(std::tuple(view.corner[c][f], static_cast<int>(c), k / kVisitKeyframes),
                          static_cast<int>(ids.size()));
          if (is_new) {
            input_.odometry.tracks.push_back({static_cast<int>(c), {}, {}});
            of_track_.push_back({view.corner[c][f], k / kVisitKeyframes, static_cast<int>(c)});
          }
          tracks.push_back(place->second);
          input_.odometry.tracks[at(place->second)].observations.push_back(
              {k, static_cast<int>(f)});
        }
      }
      keyframe.features = std::move(view.features);
      input_.odometry.keyframes.push_back(std::move(keyframe));
      input_.session.push_back(k / kVisitKeyframes);
    }
  }
  // Joins all tracks for which `name` returns the same number; negative: left out.
  template <typename Name>
  std::vector<JoinedTrack> joined(const Name& name) const {
    std::map<int, JoinedTrack> by_name;
    for (std::size_t t = 0; t < of_track_.size(); ++t) {
      const int n = name(of_track_[t]);
      if (n < 0) continue;
      JoinedTrack& track = by_name[n];
      track.revisited |= !track.views.empty();
      for (const auto& o : input_.odometry.tracks[t].observations)
        track.views.push_back({o.keyframe, input_.odometry.tracks[t].camera, o.feature});
    }
    std::vector<JoinedTrack> tracks;
    for (auto& [n, track] : by_name) {
      std::sort(track.views.begin(), track.views.end(), [](const auto& a, const auto& b) {
        return std::pair(a.keyframe, a.camera) < std::pair(b.keyframe, b.camera);
      });
      const auto same = [](const auto& a, const auto& b) {
        return a.keyframe == b.keyframe && a.camera == b.camera;
      };
      track.views.erase(std::unique(track.views.begin(), track.views.end(), same),
                        track.views.end());
      if (track.views.size() > 1) tracks.push_back(std::move(track));
    }
    triangulate_tracks(input_, poses_, {}, tracks);
    return tracks;
  }
  [[nodiscard]] int corner_at(const KeyPointId& view) const {
    const int track =
        input_.odometry.keyframes[at(view.keyframe)].tracks[at(view.camera)][at(view.feature)];
    return of_track_[at(track)].corner;
  }
  [[nodiscard]] std::set<int> corners_in(const JoinedTrack& track) const {
    std::set<int> corners;
    for (const KeyPointId& view : track.views) corners.insert(corner_at(view));
    return corners;
  }
  [[nodiscard]] std::set<int> sessions_in(const JoinedTrack& track) const {
    std::set<int> sessions;
    for (const KeyPointId& view : track.views) sessions.insert(input_.session[at(view.keyframe)]);
    return sessions;
  }
  AgreementCounts split(std::vector<JoinedTrack>& tracks, int num_threads = 0) const {
    AgreementOptions options;
    options.sigma_px = kSigma_px;
    options.num_threads = num_threads;
    return split_disagreeing_tracks(input_, poses_, options, tracks);
  }

  MappingInput input_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<test::Corner> corners_;
  std::vector<TrackOf> of_track_;  ///< of each odometry track
};

TEST_F(TwoSessionsOfCorners, JoinedRightlyStayTogetherAndLoseOneViewInTenThousand) {
  drive();
  auto tracks = joined([](const TrackOf& t) { return t.corner; });
  const std::size_t count = tracks.size();
  std::size_t views = 0;
  for (const JoinedTrack& track : tracks) views += track.views.size();
  ASSERT_GT(count, 120U);
  const AgreementCounts counts = split(tracks);
  EXPECT_EQ(counts.split, 0U);
  EXPECT_EQ(tracks.size(), count);
  // Chance beyond the gate is 1e-4: three standard deviations above the mean.
  const double mean = 1e-4 * static_cast<double>(views);
  EXPECT_LE(static_cast<double>(counts.views_dropped), mean + 3.0 * std::sqrt(mean) + 1.0);
}

// Each third corner is joined with another one in the second session.
TEST_F(TwoSessionsOfCorners, JoinedWronglyBecomeTwoCorners) {
  drive();
  auto tracks = joined([](const TrackOf& t) {
    if (t.session == 0) return t.corner % 3 == 1 ? t.corner : -1;
    return t.corner % 3 == 0 ? t.corner + 1 : -1;
  });
  const std::size_t count = tracks.size();
  std::size_t wrong = 0;
  for (const JoinedTrack& track : tracks) wrong += corners_in(track).size() > 1 ? 1 : 0;
  ASSERT_GT(wrong, 20U);
  const AgreementCounts counts = split(tracks);
  std::size_t left = 0;
  for (const JoinedTrack& track : tracks) {
    if (!track.p_map) continue;
    left += corners_in(track).size() > 1 ? 1 : 0;
    const int corner = corner_at(track.views.front());
    if (corners_in(track).size() == 1 && track.views.size() > 8) {
      EXPECT_LT((*track.p_map - corners_[at(corner)].p_world).norm(), 0.3) << corner;
    }
  }
  EXPECT_EQ(left, 0U) << "of " << wrong;
  EXPECT_GT(counts.split, wrong / 2);
  EXPECT_GE(tracks.size(), count + counts.split);
}

// Views that were matched wrongly, one by one, are dropped; the corner keeps both sessions.
TEST_F(TwoSessionsOfCorners, LoseSingleViewsThatDoNotFit) {
  drive();
  auto tracks = joined([](const TrackOf& t) { return t.corner; });
  std::size_t moved = 0;
  for (const JoinedTrack& track : tracks) {
    if (sessions_in(track).size() < 2) continue;
    const KeyPointId view = track.views[track.views.size() / 2];
    const int id =
        input_.odometry.keyframes[at(view.keyframe)].tracks[at(view.camera)][at(view.feature)];
    // A short odometry track could follow one wrong view with its position.
    if (input_.odometry.tracks[at(id)].observations.size() < 15) continue;
    input_.odometry.keyframes[at(view.keyframe)]
        .features[at(view.camera)]
        .pixels[at(view.feature)]
        .x() += 3.0F;
    ++moved;
  }
  ASSERT_GT(moved, 30U);
  const AgreementCounts counts = split(tracks);
  EXPECT_EQ(counts.split, 0U);
  EXPECT_GE(counts.views_dropped, moved);
  EXPECT_LE(counts.views_dropped, moved + moved / 10);
}

// A turned camera shifts all its views alike. That is a finding for the diagnosis, no wrong join.
TEST_F(TwoSessionsOfCorners, OfAWronglyCalibratedCameraStayTogether) {
  drive(0.02);
  auto tracks = joined([](const TrackOf& t) { return t.camera == 0 ? t.corner : -1; });
  ASSERT_GT(tracks.size(), 20U);
  const std::size_t count = tracks.size();
  split(tracks);
  std::size_t together = 0;
  for (std::size_t t = 0; t < count; ++t) together += sessions_in(tracks[t]).size() > 1 ? 1 : 0;
  EXPECT_GE(together, count * 9 / 10);
}

TEST_F(TwoSessionsOfCorners, AreSplitAlikeOnAnyNumberOfThreads) {
  drive();
  const auto wrong = [](const TrackOf& t) { return (t.corner + t.session) / 2; };
  auto one = joined(wrong);
  auto many = one;
  split(one, 1);
  split(many, 7);
  ASSERT_EQ(one.size(), many.size());
  for (std::size_t t = 0; t < one.size(); ++t) {
    EXPECT_EQ(one[t].views.size(), many[t].views.size());
    ASSERT_EQ(one[t].p_map.has_value(), many[t].p_map.has_value());
    if (one[t].p_map) {
      EXPECT_EQ(*one[t].p_map, *many[t].p_map);
    }
  }
}

}  // namespace
}  // namespace roadbook
