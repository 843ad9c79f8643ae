#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a stream of planar poses (from a map, or from the reference) if the mounting of the
// camera rig or the map is wrong.

/// Sizes of the effects "cam.X" and "map.X" seen in poses; all zero: true poses.
template <typename T>
struct PoseImperfections {
  T latency{0.0};   ///< [s]; a pose stamped t shows the vehicle at t - latency
  T rotation{0.0};  ///< [rad]; the rig looks this much to the right of its stated direction
  T position{0.0};  ///< [m]; the rig sits this much ahead of its stated position
  T scale{0.0};     ///< error of the map's scale, relative, about the first pose
  T bend{0.0};      ///< [1/m]; curvature, to the left, that the map gives a straight line along x
};

template <typename T>
struct PlanarPose {
  T x{0.0};
  T y{0.0};
  T heading{0.0};
};

/// Returns the pose that is read for the true pose `vehicle`. The shift of the rig moves the pose
/// along the vehicle's x axis. The map is bent and scaled about `origin`. A rig that looks
/// `rotation` too far to the right gives a heading too far to the right by as much. The caller
/// applies `latency`.
template <typename T>
PlanarPose<T> predict_pose(const PoseImperfections<T>& off,
                           const PlanarPose<T>& vehicle,
                           const PlanarPose<double>& origin) {
  using std::cos;
  using std::sin;
  PlanarPose<T> read = vehicle;
  read.x += off.position * cos(vehicle.heading);
  read.y += off.position * sin(vehicle.heading);
  const T x = read.x - T(origin.x);
  const T y = read.y - T(origin.y);
  read.x = T(origin.x) + (T(1.0) + off.scale) * x;
  read.y = T(origin.y) + (T(1.0) + off.scale) * (y + T(0.5) * off.bend * x * x);
  const T c = cos(vehicle.heading);
  read.heading += off.bend * x * c * c - off.rotation;
  return read;
}

/// Returns the pose in space that is read: `predict_pose` of the planar part about the drive's
/// first pose `T_world_first`. Heights are scaled about the height of that pose; roll and pitch
/// stay.
[[nodiscard]] inline Eigen::Isometry3d predict_pose(const PoseImperfections<double>& off,
                                                    const Eigen::Isometry3d& T_world_vehicle,
                                                    const Eigen::Isometry3d& T_world_first) {
  const Eigen::Vector3d p = T_world_vehicle.translation();
  const Eigen::Vector3d first = T_world_first.translation();
  const Eigen::Vector3d ahead = T_world_vehicle.linear().col(0);
  const double heading = std::atan2(ahead.y(), ahead.x());
  const PlanarPose<double> read =
      predict_pose(off, PlanarPose<double>{p.x(), p.y(), heading}, {first.x(), first.y(), 0.0});
  const double z = first.z() + (1.0 + off.scale) * (p.z() - first.z());
  const Eigen::AngleAxisd turn(read.heading - heading, Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = turn * T_world_vehicle.linear();
  T.translation() = Eigen::Vector3d(read.x, read.y, z);
  return T;
}

}  // namespace roadbook
