#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/se3.hpp"
#include "sensors/wheels.hpp"
#include "vo/features.hpp"

namespace roadbook {

// The result of visual odometry: keyframes with their features, and the tracks through them.

/// A keyframe as visual odometry estimated it, before loop closures and bundle adjustment.
struct VoKeyframe {
  std::size_t frame = 0;  ///< index in the drive
  std::int64_t t_ns = 0;
  std::vector<Features> features;        ///< per camera, pixels of the half-size images
  std::vector<std::vector<int>> tracks;  ///< per camera and feature: index of its track, -1: none
  Eigen::Isometry3d T_odom_vehicle = Eigen::Isometry3d::Identity();
  /// Motion from the previous keyframe by the wheels; empty without wheels or in a gap.
  std::optional<PlanarMotion> wheels;
  /// Information of the motion from the previous keyframe as estimated (right perturbation).
  Matrix6d information = Matrix6d::Zero();
  int inliers = 0;  ///< triangulated features that agreed with the pose
  /// Turn [rad] since the previous keyframe by the cameras alone, near the pose found with the
  /// wheels, less that of the wheels. 0 without wheels, and where the cameras know none.
  double turn_beyond_wheels_rad = 0.0;
  /// Natural logarithm of the scale (metres per unit of the odometry) here, by the cameras' height
  /// over the ground; what scales the odometry changes it. Empty with wheels, and where too little
  /// of the ground was seen.
  std::optional<double> ground_log_scale;
  double travelled_m = 0.0;  ///< since the drive's start, in the odometry's scale
  bool reversing = false;
  bool after_gap = false;  ///< the motion from the previous keyframe is unknown
};

struct TrackObservation {
  int keyframe = 0;  ///< index in VoResult::keyframes
  int feature = 0;   ///< index in the features of the track's camera
};

/// The same corner seen by one camera in at least two successive keyframes.
struct Track {
  int camera = 0;
  std::vector<TrackObservation> observations;
  /// Position in the odometry frame, triangulated with the odometry's poses; empty without enough
  /// parallax.
  std::optional<Eigen::Vector3d> p_odom;
};

/// A time in which a sensor contradicts the cameras, and what was done.
struct SensorDoubt {
  std::string sensor;  ///< "wheels0"; empty: wheels or cameras
  std::int64_t t_begin_ns = 0;
  std::int64_t t_end_ns = 0;
  std::string got;   ///< what disagrees, when and by how much
  std::string want;  ///< what a sound sensor would give, and what was done without it
};

struct VoResult {
  std::vector<VoKeyframe> keyframes;
  std::vector<Track> tracks;
  bool uses_wheels = false;  ///< false: the scale is that of the cameras' height over the ground
  std::vector<SensorDoubt> doubts;
};

}  // namespace roadbook
