#include "mapping/travelled.hpp"

#include <gtest/gtest.h>

namespace roadbook {
namespace {

// Two drives of five keyframes, 2 m apart for the odometry and 1.5 m on the map; the second one has
// a gap of 30 m before its third keyframe.
TEST(TravelledDistances, AreThoseOfTheMapAndBeginAnewWithEachSession) {
  MappingInput input;
  std::vector<Eigen::Isometry3d> T_map_vehicle;
  double x = 0.0;
  for (int k = 0; k < 10; ++k) {
    VoKeyframe keyframe;
    keyframe.travelled_m = 2.0 * (k % 5);
    keyframe.after_gap = k == 5 || k == 7;
    input.odometry.keyframes.push_back(keyframe);
    input.session.push_back(k / 5);
    x += k == 7 ? 30.0 : 1.5;
    T_map_vehicle.emplace_back(Eigen::Isometry3d::Identity());
    T_map_vehicle.back().translation().x() = x;
  }
  const auto travelled_m = travelled_distances(input, T_map_vehicle);
  const std::vector<double> wanted{0.0, 1.5, 3.0, 4.5, 6.0, 0.0, 1.5, 1.5, 3.0, 4.5};
  ASSERT_EQ(travelled_m.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) EXPECT_NEAR(travelled_m[k], wanted[k], 1e-12);
  EXPECT_TRUE(travelled_distances({}, {}).empty());
}

}  // namespace
}  // namespace roadbook
