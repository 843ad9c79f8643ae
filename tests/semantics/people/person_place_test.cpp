#include "semantics/people/person_place.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "semantics/overhead/visible_ground.hpp"
#include "semantics/people/person_search.hpp"
#include "tests/semantics/overhead_scene.hpp"

namespace roadbook {
namespace {

PersonHypothesis seen_at(const PersonBox& box) { return {box, {2.0, 0.1, 0.9}}; }

// The middle column of a window and the row of the feet lie where the camera sees the feet.
TEST(PersonCamera, AWindowStandsAlongTheImagesLocalVertical) {
  const Rig rig = test::four_fisheyes(640, 480);
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const PersonCamera camera(rig.cameras[c], {});
    for (const double turn : {-0.9, 0.0, 0.7}) {
      const double azimuth = camera.heading() + turn;
      const Eigen::Vector3d foot =
          rig.cameras[c].T_vehicle_camera.translation().cwiseProduct(Eigen::Vector3d(1, 1, 0)) +
          4.0 * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
      const PersonBox box = box_of_person(static_cast<int>(c), rig.cameras[c], foot, 1.7);
      const CylinderPatch patch = PersonWindow::patch(box);
      const cv::Mat map = camera.pixel_map(patch);
      const auto grow = static_cast<float>(1 << camera.octave_of(patch.scale));
      // The patch has a border of one pixel. The middle lies between two columns, the feet between
      // two rows.
      const auto between = [&](int row) {
        const cv::Vec2f sum = map.at<cv::Vec2f>(row, PersonWindow::kWidth / 2) +
                              map.at<cv::Vec2f>(row, PersonWindow::kWidth / 2 + 1) +
                              map.at<cv::Vec2f>(row + 1, PersonWindow::kWidth / 2) +
                              map.at<cv::Vec2f>(row + 1, PersonWindow::kWidth / 2 + 1);
        return (0.25F * sum + cv::Vec2f(0.5F, 0.5F)) * grow - cv::Vec2f(0.5F, 0.5F);
      };
      for (const double height : {0.0, 1.7}) {
        const auto pixel = rig.cameras[c].camera.project(rig.cameras[c].T_vehicle_camera.inverse() *
                                                         (foot + Eigen::Vector3d(0, 0, height)));
        ASSERT_TRUE(pixel.has_value());
        const cv::Vec2f got =
            between(PersonWindow::kMargin + (height > 0.0 ? 0 : PersonWindow::kPerson));
        EXPECT_NEAR(got[0], pixel->x(), 0.3) << c << ' ' << turn << ' ' << height;
        EXPECT_NEAR(got[1], pixel->y(), 0.3) << c << ' ' << turn << ' ' << height;
      }
    }
  }
}

TEST(PersonSearch, ACameraThatSeesNoGroundHasNoWindows) {
  MountedCamera mounted = test::four_fisheyes().cameras[0];
  const auto has_windows = [&](const MountedCamera& camera) {
    Random random(1, "windows");
    return PersonSearch(0, PersonCamera(camera, {}), {}).random_box(random).has_value();
  };
  EXPECT_TRUE(has_windows(mounted));
  mounted.T_vehicle_camera.rotate(Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitX()));  // to the sky
  mounted.camera.max_angle_rad = 0.6;
  EXPECT_FALSE(has_windows(mounted));
}

TEST(PersonPlace, FeetComeBackToWhereTheyStoodOnLevelAndOnHingedGround) {
  const Rig rig = test::four_fisheyes();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(5.0, -3.0, 0.2);
  T.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (const double slope : {0.0, 0.05}) {
    const GroundModel ground = GroundModel::plane(0.2 - slope * 5.0, {slope, 0.0});
    for (int c = 0; c < 4; ++c)
      for (const double range : {2.0, 6.0, 10.0}) {
        const PersonCamera camera(rig.cameras[static_cast<std::size_t>(c)], {});
        const MountedCamera& mounted = camera.mounted();
        Eigen::Vector3d foot = mounted.T_vehicle_camera.translation() +
                               range * Eigen::Vector3d(std::cos(camera.heading() + 0.3),
                                                       std::sin(camera.heading() + 0.3), 0.0);
        foot.z() = 0.0;
        const Eigen::Vector3d p_map = T * foot;
        foot.z() = *ground.height(p_map.x(), p_map.y()) - T.translation().z();
        PersonPlaceOptions feet_alone;
        feet_alone.sigma_height_m = 100.0;
        const auto placed = place_on_ground(seen_at(box_of_person(c, mounted, foot, 1.8)), mounted,
                                            T, ground, feet_alone);
        ASSERT_TRUE(placed.has_value());
        EXPECT_LT((placed->foot - foot.head<2>()).norm(), 0.005) << c << ' ' << range;
      }
  }
}

// If the ground lies below the plane of the wheels, a person on it is farther away and taller than
// in the search.
TEST(PersonPlace, WhatIsTooTallOrTooShortOnTheGroundIsNobody) {
  const Rig rig = test::four_fisheyes();
  const MountedCamera& mounted = rig.cameras[1];
  const Eigen::Vector3d foot(1.0, 6.0, 0.0);
  const auto on_ground_at = [&](double z, double height) {
    return place_on_ground(seen_at(box_of_person(1, mounted, foot, height)), mounted,
                           Eigen::Isometry3d::Identity(), GroundModel::plane(z));
  };
  EXPECT_TRUE(on_ground_at(0.0, 1.4));
  EXPECT_TRUE(on_ground_at(0.0, 2.0));
  EXPECT_FALSE(on_ground_at(0.0, 1.0));
  EXPECT_FALSE(on_ground_at(0.0, 2.6));
  EXPECT_FALSE(on_ground_at(-0.6, 1.8));
  EXPECT_FALSE(on_ground_at(0.4, 1.8));
}

// The box of a person, with the errors that `options` specify.
PersonBox erring_box(int camera,
                     const MountedCamera& mounted,
                     const Eigen::Vector3d& foot,
                     double height,
                     const PersonPlaceOptions& options,
                     Random& random) {
  PersonBox box = box_of_person(camera, mounted, foot, height);
  const double px = box.size / PersonWindow::kPerson;
  const double feet = px * options.sigma_foot_px * random.normal();
  box.foot_slope += feet;
  box.size += px * options.sigma_foot_px * random.normal() - feet;
  box.azimuth += px * options.sigma_side_px * random.normal();
  box.foot_slope += options.sigma_tilt_rad * random.normal();
  box.azimuth += options.sigma_tilt_rad * random.normal();
  return box;
}

// Boxes and ground height have the errors that the options specify. The mean squared normalised
// error of two coordinates is then 2.
TEST(PersonPlace, TheCovarianceIsThatOfTheErrors) {
  const Rig rig = test::four_fisheyes();
  const PersonPlaceOptions options;
  const MountedCamera& mounted = rig.cameras[1];
  Random random(3, "feet");
  double sum = 0.0;
  int placed_ones = 0;
  constexpr int kTrials = 2000;
  for (int i = 0; i < kTrials; ++i) {
    const double range = random.uniform(2.0, 7.0);
    const Eigen::Vector3d foot =
        mounted.T_vehicle_camera.translation().cwiseProduct(Eigen::Vector3d(1, 1, 0)) +
        range * Eigen::Vector3d(0.2, 0.98, 0.0).normalized();
    const double height = options.mean_height_m + options.sigma_height_m * random.normal();
    const PersonBox box = erring_box(1, mounted, foot, height, options, random);
    const GroundModel ground = GroundModel::plane(options.sigma_ground_m * random.normal());
    const auto placed =
        place_on_ground(seen_at(box), mounted, Eigen::Isometry3d::Identity(), ground, options);
    if (!placed) continue;  // the error of the window makes the height implausible
    ++placed_ones;
    const Eigen::Vector2d d = placed->foot - foot.head<2>();
    sum += d.dot(placed->covariance.inverse() * d);
  }
  // 4 sigma of the mean of chi-square(2), and a tenth for nonlinear effects.
  EXPECT_GT(placed_ones, 0.99 * kTrials);
  EXPECT_NEAR(sum / placed_ones, 2.0, 4.0 * 2.0 / std::sqrt(kTrials) + 0.2);
}

TEST(PersonPlace, TwoCamerasOnOnePersonAreOneSightingAndOneCameraOnTwoAreTwo) {
  PlacedPerson a;
  a.foot = {5.0, 1.0};
  a.covariance = 0.04 * Eigen::Matrix2d::Identity();
  a.probability = 0.9;
  PlacedPerson b = a;
  b.box.camera = 1;
  b.foot.x() += 0.3;
  b.probability = 0.7;
  PlacedPerson c = a;
  c.foot.y() += 0.6;
  c.probability = 0.8;
  const auto kept = merge_cameras({b, a, c});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].probability, 0.9);
  EXPECT_EQ(kept[1].probability, 0.8);
  // Camera 1 has only b, and b is nearer to a than to c. The merge therefore joins a and b, and c
  // stays unchanged.
  EXPECT_NEAR(kept[0].foot.x(), 5.15, 1e-12);
  EXPECT_NEAR(kept[0].covariance(0, 0), 0.02, 1e-12);
  EXPECT_EQ(kept[1].foot, c.foot);
}

// By hand: in the first coordinate, one camera's variance is 1 and the other's is 1/4, so the first
// camera gets the weight 1/5. In the second coordinate, the weights are exchanged.
TEST(PersonPlace, EachCameraWeighsAsMuchAsItKnows) {
  PlacedPerson a;
  a.covariance = Eigen::Vector2d(1.0, 0.25).asDiagonal();
  a.probability = 0.9;
  PlacedPerson b = a;
  b.box.camera = 1;
  b.foot = {0.5, 1.0};
  b.covariance = Eigen::Vector2d(0.25, 1.0).asDiagonal();
  b.probability = 0.8;
  const auto kept = merge_cameras({a, b});
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_LT((kept[0].foot - Eigen::Vector2d(0.4, 0.2)).norm(), 1e-12);
  EXPECT_LT((kept[0].covariance - 0.2 * Eigen::Matrix2d::Identity()).norm(), 1e-12);
}

// A person ahead to the left, in the images of two cameras. The merged place is nearer to the truth
// than one sighting, and its covariance is correct. The errors of the person's height and of the
// ground are common to both cameras; the merge does not model this.
TEST(PersonPlace, TheCovarianceOfTwoCamerasIsThatOfTheErrors) {
  const Rig rig = test::four_fisheyes();
  const PersonPlaceOptions options;
  Random random(4, "two cameras");
  double sum = 0.0;
  double one_m2 = 0.0;
  double both_m2 = 0.0;
  int within = 0;
  int seen = 0;
  constexpr int kTrials = 2000;
  for (int i = 0; i < kTrials; ++i) {
    const double range = random.uniform(3.0, 7.0);
    const Eigen::Vector3d foot(3.0 + 0.7 * range, 0.7 * range, 0.0);
    const double height = options.mean_height_m + options.sigma_height_m * random.normal();
    const GroundModel ground = GroundModel::plane(options.sigma_ground_m * random.normal());
    std::vector<PlacedPerson> people;
    for (const int c : {0, 1}) {
      const MountedCamera& mounted = rig.cameras[static_cast<std::size_t>(c)];
      const auto placed =
          place_on_ground(seen_at(erring_box(c, mounted, foot, height, options, random)), mounted,
                          Eigen::Isometry3d::Identity(), ground, options);
      if (placed) people.push_back(*placed);
    }
    const auto kept = merge_cameras(people);
    if (people.size() < 2 || kept.size() > 1) continue;  // more than three sigma apart
    ++seen;
    const Eigen::Vector2d d = kept[0].foot - foot.head<2>();
    const double off = d.dot(kept[0].covariance.inverse() * d);
    sum += off;
    within += off < 5.99 ? 1 : 0;
    both_m2 += d.squaredNorm();
    one_m2 += (people[0].foot - foot.head<2>()).squaredNorm();
  }
  EXPECT_GT(seen, 0.97 * kTrials);
  EXPECT_NEAR(sum / seen, 2.0, 4.0 * 2.0 / std::sqrt(kTrials) + 0.2);
  EXPECT_NEAR(static_cast<double>(within) / seen, 0.95, 0.02);
  EXPECT_LT(both_m2, 0.5 * one_m2);
}

// Cameras on all sides see as far as their range. A wall of landmarks hides the ground behind it. A
// camera without an image sees nothing.
TEST(VisibleGround, WhatStandsThereHidesWhatIsBehindIt) {
  const Rig rig = test::four_fisheyes(640, 480);
  std::vector<PersonCamera> cameras;
  for (const MountedCamera& mounted : rig.cameras) cameras.emplace_back(mounted, cv::Mat());
  const GroundModel ground = GroundModel::plane();
  Map map;
  map.map_frames.emplace_back();
  const std::vector<bool> all(4, true);
  const auto free = VisibleGround(map, ground, cameras).reach_m(Eigen::Isometry3d::Identity(), all);
  ASSERT_EQ(free.size(), static_cast<std::size_t>(VisibleGround::kBearings));
  EXPECT_NEAR(free[0], 10.0 + rig.cameras[0].T_vehicle_camera.translation().x(), 0.15);
  for (const double reach : free) EXPECT_GT(reach, 8.0);
  for (int i = -40; i <= 40; ++i)
    for (int k = 0; k < 3; ++k) {
      Landmark landmark;
      landmark.p_frame = Eigen::Vector3d(0.1 * i, 5.0, 0.5 + 0.3 * k);  // 5 m to the left
      landmark.covariance.setZero();                                    // exact
      landmark.covariance.setZero();                                    // exact
      map.landmarks.push_back(landmark);
    }
  const auto walled =
      VisibleGround(map, ground, cameras).reach_m(Eigen::Isometry3d::Identity(), all);
  const std::size_t left = VisibleGround::kBearings / 4;
  EXPECT_NEAR(walled[left], 5.0, 0.35);
  EXPECT_EQ(walled[3 * left], free[3 * left]);
  const auto blind = VisibleGround(map, ground, cameras)
                         .reach_m(Eigen::Isometry3d::Identity(), {false, false, false, true});
  EXPECT_EQ(blind[left], 0.0);
}

}  // namespace
}  // namespace roadbook
