#include "mapping/checks/join_check.hpp"

#include <gtest/gtest.h>

#include <string>

#include "base/se3.hpp"

namespace roadbook {
namespace {

// A drive of 1 m between keyframes, whose wheels count `scale` times as much. Before it, the car
// stands: wheels and poses have a noise of millimetres there.
Map driven_map(int standing, double scale) {
  Map map;
  map.sessions.resize(1);
  map.sessions[0].name = "drive";
  double x = 0.0;
  for (int k = 0; k < standing + 20; ++k) {
    Keyframe keyframe;
    keyframe.t_ns = k * std::int64_t{1'000'000'000};
    keyframe.map_frame = k;
    if (k > 0) {
      const bool stands = k <= standing;
      x += stands ? 0.004 : 1.0;
      keyframe.wheels.emplace();
      keyframe.wheels->motion.x() = stands ? 0.001 : scale;
      keyframe.wheels->covariance = 1e-6 * Eigen::Matrix3d::Identity();
    }
    map.map_frames.emplace_back().T_map_frame = pose_from_planar(x, 0.0, 0.0);
    map.keyframes.push_back(keyframe);
  }
  return map;
}

std::string wheels_named_by(const Map& map) {
  for (const Problem& problem : join_problems(map))
    if (problem.field.find("wheels") != std::string::npos) return problem.want;
  return "";
}

TEST(JoinCheck, WheelsAreJudgedWhereTheCarDrivesAndNotWhereItStands) {
  EXPECT_EQ(wheels_named_by(driven_map(0, 1.0)), "");
  EXPECT_EQ(wheels_named_by(driven_map(60, 1.0)), "");
  EXPECT_NE(wheels_named_by(driven_map(0, 0.9)).find("1.1111"), std::string::npos);
  EXPECT_NE(wheels_named_by(driven_map(60, 0.9)).find("1.1111"), std::string::npos);
}

}  // namespace
}  // namespace roadbook
