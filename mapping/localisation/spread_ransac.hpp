#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>

#include "sensors/rig.hpp"
#include "vo/rig_pose.hpp"

namespace roadbook {

struct SpreadRansacOptions {
  double inlier_rad = 0.015;  ///< angle between ray and point
  int iterations = 300;
  std::uint64_t seed = 1;
};

/// Pose of the rig by RANSAC with samples spread over the cameras (OpenGV,
/// MultiNoncentralAbsolutePoseSacProblem: the generalised three-point solver). Samples from all
/// observations together would end with the camera that has most of them. Cameras with fewer than
/// four observations are left out; if one camera remains, Kneip's three-point solver is used. The
/// pose of the best sample is returned, however few agree with it. Empty if no sample gives one.
/// Deterministic.
[[nodiscard]] std::optional<Eigen::Isometry3d> find_spread_rig_pose(
    const Rig& rig,
    std::span<const RigObservation> observations,
    const SpreadRansacOptions& options = {});

}  // namespace roadbook
