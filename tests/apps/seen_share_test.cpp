#include "workflows/people/seen_share.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace roadbook {
namespace {

constexpr double kBody_m = 0.5;

MountedCamera camera_at(double x, double y) {
  MountedCamera mounted;
  mounted.T_vehicle_camera = Eigen::Translation3d(x, y, 1.0);
  return mounted;
}

PersonInView somebody(const MountedCamera& mounted, double x, double y, double height_m = 1.75) {
  return person_in_view(0, mounted, {x, y, 0.0}, height_m);
}

TEST(SeenShare, WhoStandsBehindSomebodyIsHiddenAndNotTheOtherWayRound) {
  const MountedCamera mounted = camera_at(0.0, 0.0);
  const PersonInView near = somebody(mounted, 4.0, 0.0);
  const PersonInView far = somebody(mounted, 6.0, 0.0);
  const auto share = [&](const PersonInView& one) {
    return seen_share(one, {near, far}, mounted, Eigen::Isometry3d::Identity(), {});
  };
  EXPECT_DOUBLE_EQ(share(near), 1.0);
  // From a height of 1 m, the head of the farther person is at a lower slope than the head of the
  // nearer person, and the feet are at a higher slope.
  EXPECT_DOUBLE_EQ(share(far), 0.0);
}

// The far person is half a metre wide at 6 m. The near person at 3 m hides the part to the left of
// the middle of the image. The visible part lies between their edges.
TEST(SeenShare, TheSidePastSomebodyIsSeen) {
  const MountedCamera mounted = camera_at(0.0, 0.0);
  for (const double aside_m : {0.0, 0.1, 0.2, 0.3, 0.4, 0.6}) {
    const PersonInView far = somebody(mounted, 6.0, 0.0);
    const PersonInView near = somebody(mounted, 3.0, aside_m, 2.0);
    const double edge = (aside_m - 0.5 * kBody_m) / 3.0 * 6.0;  // of the hidden part, at 6 m
    const double seen = std::clamp((edge + 0.5 * kBody_m) / kBody_m, 0.0, 1.0);
    EXPECT_NEAR(seen_share(far, {near, far}, mounted, Eigen::Isometry3d::Identity(), {}), seen,
                0.12)  // one of five columns is 0.2
        << aside_m;
  }
}

TEST(SeenShare, AWallHidesWhatIsBehindItInTheWorldHoweverTheVehicleStands) {
  const MountedCamera mounted = camera_at(1.0, 0.5);
  Eigen::Isometry3d T_world_vehicle(Eigen::Translation3d(20.0, -7.0, 0.0));
  T_world_vehicle.rotate(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitZ()));
  const auto in_world = [&](double x, double y) {
    return Eigen::Vector2d((T_world_vehicle * Eigen::Vector3d(x, y, 0.0)).head<2>());
  };
  const PersonInView person = somebody(mounted, 6.0, 0.5);
  const auto share = [&](double from_y, double to_y, double wall_x) {
    return seen_share(person, {person}, mounted, T_world_vehicle,
                      {{in_world(wall_x, from_y), in_world(wall_x, to_y)}});
  };
  EXPECT_DOUBLE_EQ(share(0.0, 1.0, 4.0), 0.0);
  EXPECT_DOUBLE_EQ(share(0.0, 1.0, 7.0), 1.0);
  EXPECT_DOUBLE_EQ(share(2.0, 3.0, 4.0), 1.0);
  EXPECT_DOUBLE_EQ(share(0.53, 3.0, 4.0), 0.6);  // two of five columns lie to the left of it
}

}  // namespace
}  // namespace roadbook
