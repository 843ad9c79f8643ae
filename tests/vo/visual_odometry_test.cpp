#include "vo/visual_odometry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/vo/synthetic_views.hpp"

namespace roadbook {
namespace {

constexpr double kRadius = 12.0;
constexpr double kStep = 0.25;

struct Driven {
  VoResult result;
  std::vector<Eigen::Isometry3d> truth;               // of every frame
  std::vector<std::vector<std::vector<int>>> corner;  // frame, camera, feature
};

// Half a lap on a circle; the wheels, where there are any, are right but for their noise.
Driven drive(bool with_wheels,
             int cameras,
             std::uint64_t seed,
             double step_m = kStep,
             int frames = 100,
             int corner_count = 900) {
  Random random(seed, "drive");
  const Rig rig = test::fisheye_rig(cameras);
  const auto corners = test::corners_around(22.0, corner_count, random);
  VisualOdometry odometry(rig, {});
  Driven run;
  for (int i = 0; i < frames; ++i) {
    run.truth.push_back(test::on_circle(kRadius, i * step_m));
    auto view = test::view_from(run.truth.back(), rig, corners, 15.0, 0.4, random);
    run.corner.push_back(view.corner);
    VoFrame frame;
    frame.frame = static_cast<std::size_t>(i);
    frame.t_ns = i * std::int64_t{100'000'000};
    frame.features = std::move(view.features);
    if (with_wheels && i > 0) {
      const Eigen::Isometry3d T = run.truth[run.truth.size() - 2].inverse() * run.truth.back();
      frame.wheels.emplace();
      frame.wheels->motion = {T.translation().x() + random.normal(0.0, 0.004), T.translation().y(),
                              heading_of(T) + random.normal(0.0, 0.001)};
      frame.wheels->covariance = Eigen::Vector3d(2e-5, 1e-6, 1e-6).asDiagonal();
      frame.wheels->distance_m = step_m;
    }
    odometry.add(std::move(frame));
  }
  run.result = odometry.finish();
  return run;
}

// Odometry from wheels only would have errors of 1 mrad * sqrt(100) in heading, 0.14 m across and
// 0.04 m along.
TEST(VisualOdometry, FollowsALapBetterThanTheWheels) {
  double sum_m = 0.0;
  double sum_rad = 0.0;
  constexpr int kRuns = 4;
  for (int seed = 0; seed < kRuns; ++seed) {
    const Driven run = drive(true, 4, static_cast<std::uint64_t>(seed));
    ASSERT_EQ(run.result.keyframes.size(), 100U);
    const Eigen::Isometry3d T_truth = run.truth.front().inverse() * run.truth.back();
    const Eigen::Isometry3d T = run.result.keyframes.front().T_odom_vehicle.inverse() *
                                run.result.keyframes.back().T_odom_vehicle;
    sum_m += (T.translation() - T_truth.translation()).norm();
    sum_rad += so3_log(T.linear().transpose() * T_truth.linear()).norm();
  }
  EXPECT_LT(sum_m / kRuns, 0.10);
  EXPECT_LT(sum_rad / kRuns, 0.006);
}

TEST(VisualOdometry, WithoutWheelsKnowsTheScaleFromTheGround) {
  const Driven run = drive(false, 4, 2);
  ASSERT_GT(run.result.keyframes.size(), 80U);
  const auto& last = run.result.keyframes.back();
  const auto& first = run.result.keyframes.front();
  const double chord =
      (last.T_odom_vehicle.translation() - first.T_odom_vehicle.translation()).norm();
  const double truth =
      (run.truth[last.frame].translation() - run.truth[first.frame].translation()).norm();
  EXPECT_NEAR(chord / truth, 1.0, 0.05);
}

// A lap and a third by one camera.
TEST(VisualOdometry, WithOneCameraKeepsItsScaleAndHeading) {
  for (const std::uint64_t seed : {2U}) {
    const Driven run = drive(false, 1, seed, kStep, 400, 2400);
    const auto& keyframes = run.result.keyframes;
    ASSERT_GT(keyframes.size(), 300U);
    const auto saw_ground = std::count_if(keyframes.begin(), keyframes.end(), [](const auto& k) {
      return k.ground_log_scale && std::abs(*k.ground_log_scale) < 0.1;
    });
    EXPECT_GT(saw_ground, static_cast<std::ptrdiff_t>(keyframes.size() / 10)) << seed;
    std::size_t begin = 40;  // the scale is known after some metres
    for (; begin + 80 < keyframes.size(); begin += 80) {
      const auto& a = keyframes[begin];
      const auto& b = keyframes[begin + 80];
      const double truth = (static_cast<double>(b.frame) - static_cast<double>(a.frame)) * kStep;
      EXPECT_NEAR((b.travelled_m - a.travelled_m) / truth, 1.0, 0.05) << seed << " " << begin;
      const double turned = heading_of(a.T_odom_vehicle.inverse() * b.T_odom_vehicle);
      EXPECT_NEAR(wrap_angle(turned - truth / kRadius), 0.0, 0.04) << seed << " " << begin;
    }
  }
}

// FAST finds another point of an object when its image grows: a track ends before.
TEST(VisualOdometry, WithoutWheelsEndsTracksWhoseCornersComeMuchNearer) {
  const Rig rig = test::fisheye_rig(4);
  Random random(3, "drive");
  const auto corners = test::corners_around(22.0, 900, random);
  const auto share_of_long_tracks = [&](bool with_wheels) {
    const Driven run = drive(with_wheels, 4, 3);
    std::size_t much_nearer = 0;
    for (const Track& track : run.result.tracks) {
      const auto c = static_cast<std::size_t>(track.camera);
      const auto range_m = [&](const TrackObservation& o) {
        const auto frame = run.result.keyframes[static_cast<std::size_t>(o.keyframe)].frame;
        const int corner = run.corner[frame][c][static_cast<std::size_t>(o.feature)];
        return (run.truth[frame] * rig.cameras[c].T_vehicle_camera.translation() -
                corners[static_cast<std::size_t>(corner)].p_world)
            .norm();
      };
      const double ratio = range_m(track.observations.front()) / range_m(track.observations.back());
      if (std::max(ratio, 1.0 / ratio) > 2.0) ++much_nearer;
    }
    return static_cast<double>(much_nearer) / static_cast<double>(run.result.tracks.size());
  };
  EXPECT_GT(share_of_long_tracks(true), 0.05);
  EXPECT_LT(share_of_long_tracks(false), 0.01);
}

// Frames come every 0.07 m, without wheels. The odometry takes the frame nearest to 0.20 m, in the
// length unit of the odometry.
TEST(VisualOdometry, WithoutWheelsTakesTheFrameNearestToTheSpacing) {
  const Driven run = drive(false, 4, 5, 0.07);
  const auto& keyframes = run.result.keyframes;
  ASSERT_GT(keyframes.size(), 20U);
  for (std::size_t k = 2; k < keyframes.size(); ++k) {  // the first motion is taken as it comes
    if (keyframes[k].after_gap) continue;
    const double gap_m = keyframes[k].travelled_m - keyframes[k - 1].travelled_m;
    const auto frames = static_cast<double>(keyframes[k].frame - keyframes[k - 1].frame);
    EXPECT_NEAR(gap_m, 0.20, 0.5 * gap_m / frames + 0.01) << k;
  }
}

// Each track names features of one corner, keyframes ascend, and the keyframes name the track back.
TEST(VisualOdometry, TracksAndKeyframesAgree) {
  for (const bool with_wheels : {true, false}) {
    const Driven run = drive(with_wheels, 4, 3);
    const VoResult& vo = run.result;
    ASSERT_GT(vo.tracks.size(), 100U);
    std::size_t named = 0;
    std::size_t mixed = 0;
    for (std::size_t t = 0; t < vo.tracks.size(); ++t) {
      const Track& track = vo.tracks[t];
      const auto c = static_cast<std::size_t>(track.camera);
      ASSERT_GE(track.observations.size(), 2U);
      const auto corner_at = [&](const TrackObservation& o) {
        const auto& keyframe = vo.keyframes[static_cast<std::size_t>(o.keyframe)];
        return run.corner[keyframe.frame][c][static_cast<std::size_t>(o.feature)];
      };
      int last = -1;
      for (const auto& o : track.observations) {
        EXPECT_GT(o.keyframe, last);
        last = o.keyframe;
        EXPECT_EQ(vo.keyframes[static_cast<std::size_t>(o.keyframe)]
                      .tracks[c][static_cast<std::size_t>(o.feature)],
                  static_cast<int>(t));
        mixed += corner_at(o) != corner_at(track.observations.front()) ? 1U : 0U;
        ++named;
      }
    }
    std::size_t back = 0;
    for (const auto& keyframe : vo.keyframes)
      for (const auto& tracks : keyframe.tracks)
        for (const int id : tracks) back += id >= 0 ? 1U : 0U;
    EXPECT_EQ(back, named);
    EXPECT_LT(mixed, named / 200);
  }
}

TEST(VisualOdometry, TriangulatesCornersWhereTheyAre) {
  const Driven run = drive(true, 4, 4);
  std::vector<double> errors;
  Random random(4, "drive");
  const auto corners = test::corners_around(22.0, 900, random);
  for (const auto& track : run.result.tracks) {
    if (!track.p_odom || track.observations.size() < 5) continue;
    const auto& o = track.observations.front();
    const auto frame = run.result.keyframes[static_cast<std::size_t>(o.keyframe)].frame;
    const int corner = run.corner[frame][static_cast<std::size_t>(track.camera)]
                                 [static_cast<std::size_t>(o.feature)];
    const Eigen::Vector3d p_vehicle =
        run.truth[frame].inverse() * corners[static_cast<std::size_t>(corner)].p_world;
    if (p_vehicle.norm() > 10.0) continue;
    const auto& keyframe = run.result.keyframes[static_cast<std::size_t>(o.keyframe)];
    errors.push_back((keyframe.T_odom_vehicle.inverse() * *track.p_odom - p_vehicle).norm());
  }
  ASSERT_GT(errors.size(), 300U);
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05);  // mission, row 14
}

}  // namespace
}  // namespace roadbook
