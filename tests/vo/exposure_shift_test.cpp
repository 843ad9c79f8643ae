#include "vo/exposure_shift.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr int kKeyframes = 30;
constexpr double kStepS = 0.08;
constexpr std::int64_t kStartNs = 1'000'000'000;

// A car that gathers speed in a bend: 3 m/s and more, radius 12 m, in closed form.
Eigen::Isometry3d pose_at(double t_s) {
  constexpr double kBendM = 12.0;
  const double way = 3.0 * t_s + 0.5 * 0.8 * t_s * t_s;
  const double heading = way / kBendM;
  return pose_from_planar(kBendM * std::sin(heading), kBendM * (1.0 - std::cos(heading)), heading);
}

MountedCamera camera_to(double yaw) {
  MountedCamera mounted;
  mounted.camera.model = CameraModel::kKannalaBrandt;
  mounted.camera.parameters = {150.0, 150.0, 160.0, 120.0};
  mounted.camera.width = 320;
  mounted.camera.height = 240;
  Eigen::Matrix3d forward;
  forward << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mounted.T_vehicle_camera.linear() =
      Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * forward;
  mounted.T_vehicle_camera.translation() << 1.0, 0.3, 1.1;
  return mounted;
}

std::optional<Eigen::Vector2d> seen_at(const MountedCamera& mounted,
                                       const Eigen::Vector3d& p_world,
                                       double t_s) {
  const auto pixel =
      mounted.camera.project((pose_at(t_s) * mounted.T_vehicle_camera).inverse() * p_world);
  return pixel && mounted.camera.contains(*pixel, 12.0) ? pixel : std::nullopt;
}

// The row decides when it is exposed, and where the point lies then decides the row.
std::optional<Eigen::Vector2d> exposed(const MountedCamera& mounted,
                                       const Eigen::Vector3d& p_world,
                                       double stamp_s) {
  double row = 0.5 * mounted.camera.height;
  std::optional<Eigen::Vector2d> pixel;
  for (int i = 0; i < 20; ++i) {
    const double after = mounted.exposed_after_s +
                         mounted.rolling_shutter_s * ((row + 0.5) / mounted.camera.height - 0.5);
    pixel = seen_at(mounted, p_world, stamp_s + after);
    if (!pixel) return std::nullopt;
    row = pixel->y();
  }
  return pixel;
}

struct Seen {
  VoResult odometry;
  std::vector<Eigen::Vector3d> p_world;              // of each track
  std::vector<std::vector<std::vector<int>>> point;  // by keyframe, camera and feature
};

// Points around the way, as the cameras of `rig` see them. What odometry would have triangulated:
// places relative to the car as if it had stood at the stamp's pose when it was still elsewhere.
Seen look_around(const Rig& rig, bool have_tracks) {
  Random random(3, "points");
  Seen seen;
  for (int i = 0; i < 400; ++i) {
    // Points without a track are far away: only the turn moves them.
    const double far = have_tracks ? 1.0 : 1e4;
    const double angle = random.uniform(-M_PI, M_PI);
    const double range = far * random.uniform(6.0, 14.0);
    const Eigen::Vector3d middle = pose_at(0.5 * kStepS * kKeyframes).translation();
    seen.p_world.push_back(middle + Eigen::Vector3d(range * std::cos(angle),
                                                    range * std::sin(angle),
                                                    far * random.uniform(0.0, 3.0)));
  }
  auto& odometry = seen.odometry;
  std::vector<std::vector<int>> track_of(rig.cameras.size(),
                                         std::vector<int>(seen.p_world.size(), -1));
  std::vector<int> point_of_track;
  for (int k = 0; k < kKeyframes; ++k) {
    VoKeyframe keyframe;
    keyframe.t_ns = kStartNs + std::llround(1e9 * kStepS * k);
    keyframe.T_odom_vehicle = pose_at(kStepS * k);
    keyframe.features.resize(rig.cameras.size());
    keyframe.tracks.resize(rig.cameras.size());
    seen.point.emplace_back(rig.cameras.size());
    for (std::size_t c = 0; c < rig.cameras.size(); ++c)
      for (std::size_t p = 0; p < seen.p_world.size(); ++p) {
        const auto pixel = exposed(rig.cameras[c], seen.p_world[p], kStepS * k);
        if (!pixel || !seen_at(rig.cameras[c], seen.p_world[p], kStepS * k)) continue;
        int& track = track_of[c][p];
        if (have_tracks && track < 0) {
          track = static_cast<int>(odometry.tracks.size());
          odometry.tracks.push_back({static_cast<int>(c), {}, {}});
          point_of_track.push_back(static_cast<int>(p));
        }
        if (track >= 0)
          odometry.tracks[static_cast<std::size_t>(track)].observations.push_back(
              {k, static_cast<int>(keyframe.features[c].size())});
        keyframe.features[c].pixels.push_back(pixel->cast<float>());
        keyframe.tracks[c].push_back(track);
        seen.point.back()[c].push_back(static_cast<int>(p));
      }
    odometry.keyframes.push_back(std::move(keyframe));
  }
  for (std::size_t t = 0; t < odometry.tracks.size(); ++t) {
    Track& track = odometry.tracks[t];
    const double stamp = kStepS * track.observations[track.observations.size() / 2].keyframe;
    const double after = rig.cameras[static_cast<std::size_t>(track.camera)].exposed_after_s;
    track.p_odom = pose_at(stamp) * pose_at(stamp + after).inverse() *
                   seen.p_world[static_cast<std::size_t>(point_of_track[t])];
  }
  return seen;
}

// Largest distance [px] of a corner from where its point lies at the stamp, but for the worst 2 %:
// places of tracks come from the middle of each track.
double worst_px(const Rig& rig, const Seen& seen) {
  std::vector<double> off;
  for (int k = 1; k + 1 < kKeyframes; ++k)
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      const auto& keyframe = seen.odometry.keyframes[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < keyframe.features[c].size(); ++i) {
        const int p = seen.point[static_cast<std::size_t>(k)][c][i];
        const auto truth =
            seen_at(rig.cameras[c], seen.p_world[static_cast<std::size_t>(p)], kStepS * k);
        off.push_back((keyframe.features[c].pixels[i].cast<double>() - *truth).norm());
      }
    }
  std::sort(off.begin(), off.end());
  EXPECT_GT(off.size(), 1000U);
  return off[off.size() * 98 / 100];
}

// Before they are moved, corners lie at least `before_px` off; afterwards at most 0.15 px.
void expect_moved(const Rig& rig, bool have_tracks, double before_px) {
  Seen seen = look_around(rig, have_tracks);
  EXPECT_GT(worst_px(rig, seen), before_px);
  move_to_stamps(rig, seen.odometry);
  EXPECT_LT(worst_px(rig, seen), 0.15);
}

// Largest distance [m] of the place of a track from the nearest point.
double farthest_place_m(const Seen& seen) {
  double farthest = 0.0;
  for (const Track& track : seen.odometry.tracks) {
    double nearest = 1e9;
    for (const Eigen::Vector3d& p : seen.p_world)
      nearest = std::min(nearest, (p - *track.p_odom).norm());
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

TEST(ExposureShift, CornersOfALateCameraMoveToWhereTheyWereAtTheStamp) {
  Rig rig{{camera_to(0.0), camera_to(M_PI_2)}};
  rig.cameras[1].exposed_after_s = -0.04;
  expect_moved(rig, true, 2.0);
}

TEST(ExposureShift, CornersOfOtherCamerasStay) {
  Rig rig{{camera_to(0.0), camera_to(M_PI_2)}};
  rig.cameras[1].exposed_after_s = -0.04;
  Seen seen = look_around(rig, true);
  const auto before = seen.odometry.keyframes[5].features[0].pixels;
  move_to_stamps(rig, seen.odometry);
  EXPECT_EQ(seen.odometry.keyframes[5].features[0].pixels, before);
}

TEST(ExposureShift, RowsOfARollingShutterMoveToTheStamp) {
  Rig rig{{camera_to(M_PI_2)}};
  rig.cameras[0].rolling_shutter_s = 0.2;
  expect_moved(rig, true, 1.5);
}

TEST(ExposureShift, CornersWithoutAPlaceMoveByTheTurn) {
  Rig rig{{camera_to(0.0)}};
  rig.cameras[0].exposed_after_s = 0.05;
  expect_moved(rig, false, 1.5);
}

TEST(ExposureShift, PlacesOfTracksMoveWithTheCar) {
  Rig rig{{camera_to(0.0)}};
  rig.cameras[0].exposed_after_s = -0.05;
  Seen seen = look_around(rig, true);
  EXPECT_GT(farthest_place_m(seen), 0.15);
  move_to_stamps(rig, seen.odometry);
  EXPECT_LT(farthest_place_m(seen), 0.02);
}

TEST(ExposureShift, AcrossAGapTheOtherNeighbourTellsTheMotion) {
  Rig rig{{camera_to(M_PI_2)}};
  rig.cameras[0].exposed_after_s = -0.04;
  Seen seen = look_around(rig, true);
  // Behind the gap the odometry begins anew at any place.
  const Eigen::Isometry3d elsewhere = pose_from_planar(300.0, -200.0, 2.0);
  for (int k = 15; k < kKeyframes; ++k) {
    auto& T = seen.odometry.keyframes[static_cast<std::size_t>(k)].T_odom_vehicle;
    T = elsewhere * T;
  }
  seen.odometry.keyframes[15].after_gap = true;
  for (Track& track : seen.odometry.tracks) track.p_odom.reset();
  const Seen unmoved = seen;
  move_to_stamps(rig, seen.odometry);
  for (int k = 13; k < 18; ++k) {
    const auto& now = seen.odometry.keyframes[static_cast<std::size_t>(k)].features[0].pixels;
    const auto& was = unmoved.odometry.keyframes[static_cast<std::size_t>(k)].features[0].pixels;
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LT((now[i] - was[i]).norm(), 5.0F);
  }
}

}  // namespace
}  // namespace roadbook
