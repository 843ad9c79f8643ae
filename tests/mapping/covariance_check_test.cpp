#include "mapping/checks/covariance_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <string>

#include "base/random.hpp"
#include "mapping/landmark_information.hpp"

namespace roadbook {
namespace {

constexpr Eigen::Index kSeen = 30;

// Three keyframes, 1 m apart, see the same landmarks 3 to 11 m ahead.
Map seen_map() {
  Random random(6, "seen");
  Map map;
  Session& session = map.sessions.emplace_back();
  session.name = "drive";
  MountedCamera& mounted = session.rig.cameras.emplace_back();
  mounted.camera.width = 640;
  mounted.camera.height = 480;
  mounted.camera.parameters = {300.0, 300.0, 320.0, 240.0};
  mounted.T_vehicle_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (int k = 0; k < 3; ++k) {
    map.map_frames.emplace_back().T_map_frame = pose_from_planar(k, 0.0, 0.0);
    Keyframe& keyframe = map.keyframes.emplace_back();
    keyframe.t_ns = k * std::int64_t{1'000'000'000};
    keyframe.map_frame = k;
    keyframe.covariance = (k == 0 ? 0.0 : 1.0) * Matrix6d::Identity();
  }
  for (int l = 0; l < kSeen; ++l) {
    Landmark& landmark = map.landmarks.emplace_back();
    landmark.p_frame = {random.uniform(5.0, 11.0), random.uniform(-2.0, 2.0),
                        random.uniform(-2.0, 2.0)};
    for (int k = 0; k < 3; ++k) {
      Observation& o = map.observations.emplace_back();
      o.landmark = l;
      o.keyframe = k;
      const Eigen::Isometry3d T_map_camera = map.T_map_vehicle(k) * mounted.T_vehicle_camera;
      o.pixel = mounted.camera.project(T_map_camera.inverse() * landmark.p_frame)->cast<float>();
    }
  }
  const auto information = landmark_information(map);
  for (std::size_t l = 0; l < information.size(); ++l)
    map.landmarks[l].covariance = information[l].inverse();
  return map;
}

// Covariance of the second pose if the others are known and the landmarks are free, by the inverse
// of all unknowns' information.
Matrix6d covariance_of_second_pose(const Map& map) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(6 + 3 * kSeen, 6 + 3 * kSeen);
  for (const Observation& o : map.observations) {
    const auto terms = terms_of(map, o);
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2, 6 + 3 * kSeen);
    if (o.keyframe == 1) J.leftCols<6>() = terms->J_pose;
    J.middleCols<3>(6 + 3 * o.landmark) = terms->J_point;
    information += J.transpose() * J;
  }
  return information.inverse().topLeftCorner<6, 6>();
}

// Half of it is allowed: kLeastShare.
TEST(CovarianceCheck, PosesAreNamedThatClaimMoreThanTheirViewsOfUncertainLandmarksGive) {
  Map map = seen_map();
  const Matrix6d least = covariance_of_second_pose(map);
  map.keyframes[1].covariance = 0.6 * least;
  EXPECT_TRUE(covariance_problems(map).empty());
  map.keyframes[1].covariance = 0.4 * least;
  const auto problems = covariance_problems(map);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(problems[0].field.find("poses of session drive"), std::string::npos);
}

}  // namespace
}  // namespace roadbook
