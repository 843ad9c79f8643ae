#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/detections.hpp"
#include "drive/drive.hpp"

namespace roadbook {

// Detections of a pedestrian detector in one drive, in the frame of the poses.

/// One detection of a pedestrian.
struct Sighting {
  double t_s = 0.0;
  std::size_t look = 0;                             ///< index of the detector frame in `looks`
  Eigen::Vector2d mount = Eigen::Vector2d::Zero();  ///< camera position, vehicle frame [m]
  Eigen::Vector2d eye = Eigen::Vector2d::Zero();    ///< camera position, frame of the poses [m]
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< stated [m^2]
};

/// A detector frame (one run of the detector), with the pose and motion of the vehicle.
struct DetectorFrame {
  double t_s = 0.0;
  double x = 0.0, y = 0.0, heading = 0.0;
  double speed = 0.0;
  double yaw_rate = 0.0;
  std::vector<double>
      reach_m;  ///< visible range by sector, counted from the heading; empty: unknown
};

struct SightingReadings {
  std::vector<DetectorFrame> looks;     ///< ascending in time
  std::vector<Sighting> sightings;      ///< ascending in time
  std::vector<Eigen::Vector2d> mounts;  ///< positions of all cameras with detections, vehicle frame
  double nearest_m = 0.0;     ///< smallest range of any detection; nearer ground counts as blind
  bool frames_known = false;  ///< else only frames with detections are known
  std::vector<std::string> notes;

  /// Position of a camera in a detector frame, frame of the poses.
  [[nodiscard]] Eigen::Vector2d eye_at(std::size_t look, const Eigen::Vector2d& mount) const;
  /// True if the ground at `place` was visible in the frame: at least 0.5 m within the visible
  /// range, and not nearer to a camera than any detection. True if the visible range is unknown.
  [[nodiscard]] bool in_sight(std::size_t look, const Eigen::Vector2d& place) const;
};

/// Converts detections and detector frames to the frame of the poses. `origin_ns`: stamp at which
/// the time of the poses is 0. Entries at times without a pose are left out. A detection without a
/// camera is assigned to the nearest camera of `rig` that faces it, or to the vehicle's origin
/// without a rig.
[[nodiscard]] SightingReadings sighting_readings(const std::vector<Detection>& detections,
                                                 const std::vector<Look>& looks,
                                                 const Rig& rig,
                                                 const std::vector<PoseSample>& poses,
                                                 std::int64_t origin_ns);
/// The same for the tables in a drive's `detector0/`; empty if there are none. Throws BadInput.
[[nodiscard]] SightingReadings sighting_readings(const Drive& drive,
                                                 const std::vector<PoseSample>& poses);

}  // namespace roadbook
