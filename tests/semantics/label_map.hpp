#pragma once

#include "base/se3.hpp"
#include "mapping/map.hpp"
#include "tests/support/fisheye_rig.hpp"

namespace roadbook::test {

/// A drive along the x axis on slightly tilted ground, with a keyframe every half metre. The poses
/// have standard deviations of 3 cm and 0.2 degrees.
inline Map label_map(int keyframes) {
  Map map;
  Session session;
  session.name = "drive";
  session.drive_path = "drive";
  session.drive_digest = "0";
  session.rig = fisheye_rig();
  session.t_begin_ns = 1'400'000'000'000'000'000;
  session.t_end_ns = session.t_begin_ns + keyframes * std::int64_t{100'000'000};
  map.sessions.push_back(session);
  for (int k = 0; k < keyframes; ++k) {
    const Eigen::Isometry3d T_map_vehicle =
        pose_from_planar(0.5 * k, 0.05 * k, 0.01 * k) *
        Eigen::AngleAxisd(0.017, Eigen::Vector3d(1.0, 0.5, 0.0).normalized());
    map.map_frames.push_back({T_map_vehicle});
    Keyframe keyframe;
    keyframe.t_ns = session.t_begin_ns + k * std::int64_t{100'000'000};
    keyframe.drive_frame = k;
    keyframe.map_frame = k;
    keyframe.covariance.setZero();
    keyframe.covariance.diagonal().head<3>().setConstant(0.03 * 0.03);
    keyframe.covariance.diagonal().tail<3>().setConstant(0.0035 * 0.0035);
    keyframe.travelled_m = 0.5 * k;
    map.keyframes.push_back(keyframe);
  }
  return map;
}

}  // namespace roadbook::test
