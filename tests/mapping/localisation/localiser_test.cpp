#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <functional>

#include "base/error.hpp"
#include "tests/mapping/localisation/synthetic_place.hpp"

namespace roadbook {
namespace {

constexpr double kRadius = 16.0;
constexpr double kFrameStep = 0.16;  // [m] of a frame at 2 m/s and 12.5 Hz

// One frame of a synthetic drive and what became of it.
struct Driven {
  Eigen::Isometry3d T_true;
  LocalisedFrame pose;
  [[nodiscard]] Vector6d error() const { return se3_log(pose.T_map_vehicle.inverse() * T_true); }
  [[nodiscard]] double off_m() const { return error().head<3>().norm(); }
  [[nodiscard]] double nees() const {
    return error().dot(pose.local_covariance.ldlt().solve(error())) / 6.0;
  }
  [[nodiscard]] bool has_fix() const {
    return pose.status == LocalisationStatus::kLocalised ||
           pose.status == LocalisationStatus::kRelocalised;
  }
};

struct RingDrive {
  int frames = 60;
  double begin_m = 0.0;
  double left_m = 0.4;
  double wheel_scale = 1.0;
  bool has_wheels = true;
  std::uint64_t seed = 1;
  test::SyntheticFrameOptions corners;
  std::function<double(int)> way_m = [](int i) { return kFrameStep * i; };
  std::function<void(int, std::vector<Features>&)> change = [](int, std::vector<Features>&) {};
  std::function<bool(int)> is_missing = [](int) { return false; };
};

std::vector<Driven> drive_through(const test::SyntheticPlace& place,
                                  const LandmarkIndex& index,
                                  const RingDrive& drive,
                                  const LocaliserOptions& options = {}) {
  Localiser localiser(index, place.half_rig, options);
  Random random(drive.seed, "synthetic drive");
  std::vector<Driven> driven;
  for (int i = 0; i < drive.frames; ++i) {
    const Eigen::Isometry3d T =
        test::ring_pose(kRadius, drive.begin_m + drive.way_m(i), drive.left_m);
    auto features = test::synthetic_features(place, T, random, drive.corners);
    if (drive.is_missing(i)) continue;
    drive.change(i, features);
    LocaliserFrame frame;
    frame.frame = static_cast<std::size_t>(i);
    frame.t_ns = i * 80'000'000LL;
    frame.features = std::move(features);
    if (drive.has_wheels && !driven.empty())
      frame.wheels = test::synthetic_wheels(driven.back().T_true, T, random, drive.wheel_scale);
    driven.push_back({T, localiser.add(std::move(frame))});
    if (!localiser.confirmed()) continue;
    for (std::size_t k = driven.size() - 1; k-- > 0 && driven[k].pose.tentative;)
      driven[k].pose.status = LocalisationStatus::kRelocalised;
  }
  return driven;
}

double largest_off(const std::vector<Driven>& driven) {
  double largest = 0.0;
  for (const Driven& d : driven)
    if (d.pose.status != LocalisationStatus::kLost) largest = std::max(largest, d.off_m());
  return largest;
}

std::size_t fixes(const std::vector<Driven>& driven) {
  return static_cast<std::size_t>(
      std::count_if(driven.begin(), driven.end(), [](const Driven& d) { return d.has_fix(); }));
}

// Covariances judged by the truth. Each drive has another map with other errors. The last frames of
// a drive count, when the localiser knows the noise of the place; frames of one drive see the same
// landmarks, so each drive counts once in the bounds (3 standard errors).
TEST(Localiser, CovariancesHoldOverManyDrives) {
  constexpr int kDrives = 25;
  constexpr std::size_t kUsed = 5;
  double nees = 0.0;
  double in_ellipse = 0.0;
  int count = 0;
  for (int d = 0; d < kDrives; ++d) {
    test::SyntheticPlaceOptions options;
    options.point_count = 1000;
    options.spacing_m = 3.0;
    const auto place = test::synthetic_place(static_cast<std::uint64_t>(100 + d), options);
    const LandmarkIndex index(place.map);
    RingDrive drive;
    drive.frames = 25;
    drive.begin_m = 3.0 * d;
    drive.seed = static_cast<std::uint64_t>(d);
    const auto driven = drive_through(place, index, drive);
    ASSERT_EQ(fixes(driven), driven.size()) << d;
    for (std::size_t i = driven.size() - kUsed; i < driven.size(); ++i) {
      nees += driven[i].nees();
      const Eigen::Vector2d place_error = driven[i].error().head<2>();
      const Eigen::Matrix2d C = driven[i].pose.local_covariance.topLeftCorner<2, 2>();
      in_ellipse += place_error.dot(C.ldlt().solve(place_error)) < 5.991 ? 1.0 : 0.0;
      ++count;
    }
  }
  // A drive's mean of chi-square with 6 degrees of freedom over 6 has the variance 1/3.
  EXPECT_NEAR(nees / count, 1.0, 3.0 * std::sqrt(1.0 / 3.0 / kDrives));
  EXPECT_NEAR(in_ellipse / count, 0.95, 3.0 * std::sqrt(0.95 * 0.05 / kDrives));
}

TEST(Localiser, UncertaintyGrowsWithoutLandmarksAndShrinksAtTheNextOnes) {
  const auto place = test::synthetic_place(1);
  const LandmarkIndex index(place.map);
  RingDrive drive;
  drive.frames = 160;
  constexpr int kBegin = 60;
  constexpr int kEnd = kBegin + 62;  // 10 m
  drive.change = [](int i, std::vector<Features>& all) {
    if (i >= kBegin && i < kEnd)
      for (Features& f : all) f = {};
  };
  const auto driven = drive_through(place, index, drive);
  double before = 0.0;
  for (int i = kBegin; i < kEnd; ++i) {
    const Driven& d = driven[at(i)];
    ASSERT_EQ(d.pose.status, LocalisationStatus::kPredicted) << i;
    const double sigma = std::sqrt(d.pose.local_covariance(0, 0));
    EXPECT_GT(sigma, before) << i;
    EXPECT_LT(d.error().head<2>().norm(),
              3.5 * std::hypot(sigma, std::sqrt(d.pose.local_covariance(1, 1))));
    before = sigma;
  }
  // The noise of the wheels over 10 m: 1 cm per root metre, and 2 % that does not average out.
  EXPECT_NEAR(before, std::hypot(0.01 * std::sqrt(10.0), 0.02 * 10.0), 0.03);
  EXPECT_NEAR(driven[kEnd - 1].pose.since_fix_m, 62 * kFrameStep, 0.3);
  EXPECT_TRUE(driven[kEnd].has_fix());
  EXPECT_LT(std::sqrt(driven[kEnd].pose.local_covariance(0, 0)), 0.02);
  EXPECT_LT(driven[kEnd].off_m(), 0.03);
}

TEST(Localiser, IsFoundWithoutAGuessAnywhereAndInEitherDirection) {
  const auto place = test::synthetic_place(2);
  const LandmarkIndex index(place.map);
  for (int i = 0; i < 8; ++i) {
    RingDrive drive;
    drive.frames = 24;
    drive.begin_m = 12.3 * i;
    drive.seed = static_cast<std::uint64_t>(i);
    if (i % 2 == 1) drive.way_m = [](int f) { return -kFrameStep * f; };  // reversing
    const auto driven = drive_through(place, index, drive);
    EXPECT_TRUE(driven.back().has_fix()) << i;
    EXPECT_LT(largest_off(driven), 0.05) << i;
    EXPECT_EQ(driven[5].pose.status, LocalisationStatus::kRelocalised) << i;
  }
}

TEST(Localiser, LateImagesAreSeenFromWhereTheCarWas) {
  constexpr double kFramesLate = 1.25;
  auto place = test::synthetic_place(2);
  const LandmarkIndex index(place.map);
  const test::SyntheticPlace stated = place;
  for (MountedCamera& camera : place.half_rig.cameras) camera.exposed_after_s = -kFramesLate * 0.08;
  for (const bool has_wheels : {true, false}) {
    RingDrive drive;
    drive.has_wheels = has_wheels;
    Random random(7, "late corners");
    drive.change = [&](int i, std::vector<Features>& features) {
      features = test::synthetic_features(
          stated, test::ring_pose(kRadius, kFrameStep * (i - kFramesLate), drive.left_m), random,
          drive.corners);
    };
    const auto late = drive_through(stated, index, drive);
    EXPECT_NEAR(late.back().off_m(), kFrameStep * kFramesLate, 0.03);
    const auto driven = drive_through(place, index, drive);
    EXPECT_TRUE(driven.back().has_fix());
    EXPECT_LT(driven.back().off_m(), 0.03);
  }
}

TEST(Localiser, AnotherPlaceIsLost) {
  const auto place = test::synthetic_place(3);
  const auto other = test::synthetic_place(4);
  const LandmarkIndex index(other.map);
  const auto driven = drive_through(place, index, {});
  EXPECT_EQ(fixes(driven), 0U);
  for (const Driven& d : driven) EXPECT_EQ(d.pose.status, LocalisationStatus::kLost);
}

// 20,000 equal descriptors give no pose, and no crash.
TEST(Localiser, EqualDescriptorsAreLost) {
  test::SyntheticPlaceOptions options;
  options.point_count = 20000;
  options.spacing_m = 20.0;
  options.reach_m = 6.0;
  auto place = test::synthetic_place(5, options);
  for (Landmark& landmark : place.map.landmarks) landmark.descriptor = Descriptor{};
  for (Descriptor& d : place.descriptors) d = Descriptor{};
  const LandmarkIndex index(place.map);
  Random random(1, "equal");
  test::SyntheticFrameOptions corners;
  corners.flipped_bits = 0;
  corners.reach_m = 6.0;
  const FrameCorners frame(
      place.half_rig,
      test::synthetic_features(place, test::ring_pose(kRadius, 3.0), random, corners));
  EXPECT_FALSE(Relocaliser(index, {}).find(place.half_rig, frame, {}));
}

TEST(Localiser, StandsFaultsOfADrive) {
  const auto place = test::synthetic_place(6);
  const LandmarkIndex index(place.map);
  const auto expect_good = [&](const char* what, const RingDrive& drive, double off_m) {
    const auto driven = drive_through(place, index, drive);
    EXPECT_GT(fixes(driven), driven.size() * 9 / 10) << what;
    EXPECT_LT(largest_off(driven), off_m) << what;
  };
  RingDrive dies;
  dies.change = [](int i, std::vector<Features>& all) {
    if (i > 30) all[2] = {};
  };
  expect_good("a camera dies", dies, 0.05);
  RingDrive wheels;
  wheels.wheel_scale = 1.01;
  expect_good("wheels 1 % too large", wheels, 0.05);
  RingDrive missing;
  missing.is_missing = [](int i) { return i == 30 || i == 31; };
  expect_good("0.2 s without images", missing, 0.05);
  RingDrive stands;
  stands.way_m = [](int i) { return kFrameStep * (i < 20 ? i : i < 40 ? 20 : i - 20); };
  expect_good("the car stands", stands, 0.05);
  RingDrive blind;
  blind.has_wheels = false;
  expect_good("no wheels", blind, 0.05);
  RingDrive gone;
  gone.corners.gone_share = 0.6;
  expect_good("60 % of the landmarks are gone", gone, 0.08);
}

// A standing car sees the same landmarks with the same errors: its uncertainty must not fall below
// what one frame knows.
TEST(Localiser, ACarThatStandsDoesNotBecomeSurer) {
  const auto place = test::synthetic_place(7);
  const LandmarkIndex index(place.map);
  RingDrive drive;
  drive.frames = 110;
  drive.way_m = [](int i) { return kFrameStep * std::min(i, 30); };
  const auto driven = drive_through(place, index, drive);
  const auto sigma = [&](std::size_t i) {
    return std::sqrt(driven[i].pose.local_covariance(0, 0));
  };
  EXPECT_GT(sigma(109), 0.6 * sigma(40));
  EXPECT_LT(sigma(109), 1.5 * sigma(40));
}

// Nothing shows that the car brakes: its pose runs ahead, and the stated uncertainty with it.
TEST(Localiser, UncertaintyCoversACarThatBrakesUnseenWithoutWheels) {
  const auto place = test::synthetic_place(9);
  const LandmarkIndex index(place.map);
  RingDrive drive;
  drive.has_wheels = false;
  drive.frames = 110;
  static constexpr int kDark = 40;
  static constexpr int kGoesOn = 66;
  drive.way_m = [](int i) {  // stops at once
    return kFrameStep * (std::min(i, kDark) + std::max(0, i - kGoesOn));
  };
  drive.change = [](int i, std::vector<Features>& all) {
    if (i >= kDark && i < kDark + 25)
      for (Features& f : all) f = {};
  };
  const auto driven = drive_through(place, index, drive);
  int predicted = 0;
  for (const Driven& d : driven) {
    if (d.pose.status != LocalisationStatus::kPredicted) continue;
    ++predicted;
    const Eigen::Vector2d off = d.error().head<2>();
    const Eigen::Matrix2d C = d.pose.local_covariance.topLeftCorner<2, 2>();
    EXPECT_LT(off.dot(C.ldlt().solve(off)), 9.2) << d.pose.frame;
  }
  EXPECT_GE(predicted, 3);
  EXPECT_TRUE(driven.back().has_fix()) << "found again";
  EXPECT_LT(driven.back().off_m(), 0.05);
}

// The wheels report no motion for 2 s while the car drives on.
TEST(Localiser, WheelsThatAreStuckAreLeftOut) {
  const auto place = test::synthetic_place(10);
  const LandmarkIndex index(place.map);
  Localiser localiser(index, place.half_rig, {});
  Random random(1, "stuck");
  int fixes = 0;
  constexpr int kFrames = 110;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Isometry3d T = test::ring_pose(kRadius, kFrameStep * i);
    LocaliserFrame frame;
    frame.t_ns = i * 80'000'000LL;
    frame.features = test::synthetic_features(place, T, random);
    const bool is_stuck = i > 40 && i <= 65;
    const Eigen::Isometry3d before = is_stuck ? T : test::ring_pose(kRadius, kFrameStep * (i - 1));
    if (i > 0) frame.wheels = test::synthetic_wheels(before, T, random);
    const LocalisedFrame pose = localiser.add(std::move(frame));
    if (pose.status != LocalisationStatus::kLocalised) continue;
    ++fixes;
    EXPECT_LT((pose.T_map_vehicle.translation() - T.translation()).norm(), 0.05) << i;
  }
  EXPECT_GT(fixes, kFrames - 13 - 12) << "all but the first 2 m and half of the time stuck";
}

// One rear wheel counts nothing: the wheels predict a turn that leaves no landmark where it is
// expected.
TEST(Localiser, WheelsThatTurnTheCarAreLeftOut) {
  const auto place = test::synthetic_place(12);
  const LandmarkIndex index(place.map);
  Localiser localiser(index, place.half_rig, {});
  Random random(1, "turning wheels");
  int fixes = 0;
  constexpr int kFrames = 60;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Isometry3d T = test::ring_pose(kRadius, kFrameStep * i);
    LocaliserFrame frame;
    frame.t_ns = i * 80'000'000LL;
    frame.features = test::synthetic_features(place, T, random);
    if (i > 0) {
      frame.wheels =
          test::synthetic_wheels(test::ring_pose(kRadius, kFrameStep * (i - 1)), T, random);
      frame.wheels->motion.z() -= 0.1;
    }
    const LocalisedFrame pose = localiser.add(std::move(frame));
    if (pose.status != LocalisationStatus::kLocalised) continue;
    ++fixes;
    EXPECT_LT((pose.T_map_vehicle.translation() - T.translation()).norm(), 0.05) << i;
  }
  EXPECT_GT(fixes, kFrames - 20) << "all but the first 2 m";
}

TEST(Localiser, AWrongStartIsForgotten) {
  const auto place = test::synthetic_place(11);
  const LandmarkIndex index(place.map);
  Localiser localiser(index, place.half_rig, {});
  const Eigen::Isometry3d wrong = test::ring_pose(kRadius, 45.0);
  localiser.start_near(wrong.translation().x(), wrong.translation().y(), heading_of(wrong));
  Random random(1, "wrong start");
  LocalisedFrame last;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Isometry3d T = test::ring_pose(kRadius, kFrameStep * i);
    LocaliserFrame frame;
    frame.t_ns = i * 80'000'000LL;
    frame.features = test::synthetic_features(place, T, random);
    if (i > 0)
      frame.wheels =
          test::synthetic_wheels(test::ring_pose(kRadius, kFrameStep * (i - 1)), T, random);
    last = localiser.add(std::move(frame));
    EXPECT_TRUE(last.status == LocalisationStatus::kLost || i > 25) << i;
  }
  EXPECT_EQ(last.status, LocalisationStatus::kLocalised);
}

TEST(Localiser, StartsWhereItIsTold) {
  const auto place = test::synthetic_place(8);
  const LandmarkIndex index(place.map);
  LocaliserOptions options;
  options.may_relocalise = false;
  Localiser lost(index, place.half_rig, options);
  Localiser started(index, place.half_rig, options);
  const Eigen::Isometry3d T = test::ring_pose(kRadius, 20.0, 0.3);
  started.start_near(T.translation().x() + 1.0, T.translation().y() - 0.5, heading_of(T) + 0.1);
  Random random(1, "start");
  const auto frame = [&] {
    LocaliserFrame f;
    f.features = test::synthetic_features(place, T, random);
    return f;
  };
  EXPECT_EQ(lost.add(frame()).status, LocalisationStatus::kLost);
  const LocalisedFrame found = started.add(frame());
  EXPECT_EQ(found.status, LocalisationStatus::kLocalised);
  EXPECT_LT((found.T_map_vehicle.translation() - T.translation()).norm(), 0.03);
  EXPECT_THROW(started.start_near(500.0, 0.0, 0.0), InvalidOption);
}

}  // namespace
}  // namespace roadbook
