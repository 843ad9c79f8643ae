#include "sensors/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

VehicleMeasures passat() {  // of KITTI's car
  VehicleMeasures v;
  v.length_m = 4.77;
  v.width_m = 1.82;
  v.height_m = 1.51;
  v.rear_overhang_m = 1.07;
  v.wheelbase_m = 2.71;
  v.track_width_m = 1.55;
  return v;
}

TEST(Vehicle, BodyReachesFromTheRearAxleToBothBumpers) {
  const auto body = passat().body();
  ASSERT_TRUE(body);
  EXPECT_DOUBLE_EQ(body->min().x(), -1.07);
  EXPECT_DOUBLE_EQ(body->max().x(), 4.77 - 1.07);
  EXPECT_DOUBLE_EQ(body->min().y(), -0.91);
  EXPECT_DOUBLE_EQ(body->max().y(), 0.91);
  EXPECT_DOUBLE_EQ(body->min().z(), 0.0);
  EXPECT_DOUBLE_EQ(body->max().z(), 1.51);
  EXPECT_NEAR(*passat().front_overhang_m(), 0.99, 1e-12);
}

TEST(Vehicle, EstimatesWhatIsNotKnown) {
  VehicleMeasures v = passat();
  v.width_m.reset();
  EXPECT_NEAR(v.body()->max().y(), 0.5 * (1.55 + 0.25), 1e-12);
  v = passat();
  v.length_m.reset();
  EXPECT_FALSE(v.front_overhang_m());
  EXPECT_NEAR(v.body()->max().x(), 2.71 + 1.07, 1e-12) << "both overhangs alike";
  v = passat();
  v.rear_overhang_m.reset();
  EXPECT_NEAR(v.body()->min().x(), -0.5 * (4.77 - 2.71), 1e-12);
  v.wheelbase_m.reset();
  EXPECT_NEAR(v.body()->min().x(), -0.2 * 4.77, 1e-12);
  v = passat();
  v.height_m.reset();
  EXPECT_TRUE(std::isinf(v.body()->max().z()));
  for (auto key : {&VehicleMeasures::length_m, &VehicleMeasures::width_m}) {
    VehicleMeasures little;
    little.height_m = 1.5;
    little.*key = 2.0;
    EXPECT_FALSE(little.body());
  }
}

TEST(Vehicle, ACameraOnTheRoofSeesTheRoadAhead) {
  const auto body = *passat().body();
  const Eigen::Vector3d on_roof(1.03, 0.06, 1.65);
  EXPECT_FALSE(is_hidden_by_body(body, on_roof, {8.0, 0.5, 0.0}));
  EXPECT_TRUE(is_hidden_by_body(body, on_roof, {3.0, 0.5, 0.0})) << "under the car";
  const Eigen::Vector3d behind_windscreen(1.4, 0.0, 1.3);
  EXPECT_FALSE(is_hidden_by_body(body, behind_windscreen, {8.0, 0.5, 0.0}));
}

TEST(Vehicle, ACameraAtTheMirrorDoesNotSeeTheOtherSide) {
  const auto body = *passat().body();
  const Eigen::Vector3d mirror(1.9, 0.98, 0.96);
  EXPECT_FALSE(is_hidden_by_body(body, mirror, {1.9, 3.0, 0.0}));
  EXPECT_FALSE(is_hidden_by_body(body, mirror, {8.0, 1.0, 0.0}));
  EXPECT_TRUE(is_hidden_by_body(body, mirror, {1.9, -3.0, 0.0}));
  VehicleMeasures tall = passat();
  tall.height_m.reset();
  EXPECT_TRUE(is_hidden_by_body(*tall.body(), {1.9, 2.0, 5.0}, {1.9, -3.0, 0.0}));
}

// The slow judge: points along the line of sight.
TEST(Vehicle, HidesWhatALineOfSightThroughTheBodyWouldMeet) {
  const auto body = *passat().body();
  Random random(1, "lines of sight");
  int hidden = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d eye(random.uniform(-4, 8), random.uniform(-4, 4), random.uniform(0.1, 3));
    const Eigen::Vector3d place(random.uniform(-9, 9), random.uniform(-9, 9), 0.0);
    if (is_above_body(body, eye)) continue;
    bool meets = is_above_body(body, place);
    double closest = 1.0;  // to the border between meeting and passing
    for (int k = 0; k <= 4000; ++k) {
      const Eigen::Vector3d p = eye + k / 4000.0 * (place - eye);
      const double inside =
          std::min({p.x() - body.min().x(), body.max().x() - p.x(), p.y() - body.min().y(),
                    body.max().y() - p.y(), body.max().z() - p.z()});
      meets = meets || inside > 0.0;
      closest = std::min(closest, std::abs(inside));
    }
    const bool said = is_hidden_by_body(body, eye, place);
    // A line that only grazes an edge falls between two of the points.
    if (said != meets) {
      EXPECT_LT(closest, 0.01) << eye.transpose() << " to " << place.transpose();
    }
    hidden += said ? 1 : 0;
  }
  EXPECT_GT(hidden, 300);
}

TEST(Vehicle, CamerasRoundTheCarEncloseWhatItStandsOn) {
  Rig rig;
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(3.5, 0, 0.66), Eigen::Vector3d(1.7, 1.0, 0.96),
        Eigen::Vector3d(-0.8, 0, 0.86), Eigen::Vector3d(1.7, -1, 0.97)}) {
    rig.cameras.emplace_back();
    rig.cameras.back().T_vehicle_camera.translation() = at;
  }
  const auto outline = body_or_outline({}, rig);
  EXPECT_TRUE(
      is_hidden_by_body(outline, rig.cameras[1].T_vehicle_camera.translation(), {1.7, -2.0, 0.0}));
  for (const auto& mounted : rig.cameras) {
    const Eigen::Vector3d at = mounted.T_vehicle_camera.translation();
    const Eigen::Vector3d away = at + 3.0 * (at - Eigen::Vector3d(1.35, 0.0, at.z())).normalized();
    EXPECT_FALSE(is_hidden_by_body(outline, at, {away.x(), away.y(), 0.0}));
  }
  rig.cameras.resize(1);
  EXPECT_FALSE(is_hidden_by_body(body_or_outline({}, rig), {3.5, 0, 0.66}, {6.0, 0.0, 0.0}));
  EXPECT_TRUE(body_or_outline({}, {}).isEmpty());
}

}  // namespace
}  // namespace roadbook
