#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/detections.hpp"
#include "drive/drive.hpp"

namespace roadbook {

// What a detector of people said of a drive, in the frame of the poses.

/// Somebody found.
struct Sighting {
  double t_s = 0.0;
  std::size_t look = 0;                             ///< index into the looks
  Eigen::Vector2d mount = Eigen::Vector2d::Zero();  ///< of the camera, vehicle frame
  Eigen::Vector2d eye = Eigen::Vector2d::Zero();    ///< where it was
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< stated [m^2]
};

/// An instant at which people were looked for, with the motion of the vehicle.
struct LookPose {
  double t_s = 0.0;
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;
  double yaw_rate = 0.0;
  std::vector<double> reach_m;  ///< by sector from the heading; empty: not told
};

struct SightingReadings {
  std::vector<LookPose> looks;          ///< by time
  std::vector<Sighting> sightings;      ///< by time
  std::vector<Eigen::Vector2d> mounts;  ///< of all cameras that saw somebody, vehicle frame
  double nearest_m = 0.0;               ///< of all sightings, from their camera: nearer is blind
  bool looks_told = false;  ///< else only instants at which somebody was found are known
  std::vector<std::string> notes;

  /// Where a camera was at a look.
  [[nodiscard]] Eigen::Vector2d eye_at(std::size_t look, const Eigen::Vector2d& mount) const;
  /// Whether the ground there was seen, half a metre within what was: not hidden, nor nearer to a
  /// camera than anybody was ever found. True as far as it is not told.
  [[nodiscard]] bool in_sight(std::size_t look, const Eigen::Vector2d& place) const;
};

/// `origin_ns`: stamp at which the poses' time is 0. Detections and looks at times without a pose
/// are left out. Detections that do not say whose camera saw them are those of the nearest camera
/// of `rig` that faces them, or of the vehicle's origin where there is no rig.
[[nodiscard]] SightingReadings sighting_readings(const std::vector<Detection>& detections,
                                                 const std::vector<Look>& looks,
                                                 const Rig& rig,
                                                 const std::vector<PoseSample>& poses,
                                                 std::int64_t origin_ns);
/// The tables in a drive's `detector0/`; empty where it has none. Throws BadInput.
[[nodiscard]] SightingReadings sighting_readings(const Drive& drive,
                                                 const std::vector<PoseSample>& poses);

}  // namespace roadbook
