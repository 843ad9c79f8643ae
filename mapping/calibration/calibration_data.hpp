#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/se3.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/adjustment_problem.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// The measurements of mapped drives from which a calibration is estimated.

/// A vehicle pose. Its images are those of one stamp.
struct CalibrationPose {
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();
  Vector6d twist = Vector6d::Zero();  ///< velocity [m/s] and turn rate [rad/s], vehicle frame
  std::int64_t t_ns = 0;
  bool joined = false;  ///< the motion from the pose before is known
  bool fixed = false;   ///< the first pose of a piece, which holds the gauge
  int piece = 0;        ///< poses of different pieces have no common place
  int stretch = 0;      ///< of some metres; errors within a stretch are not independent
};

/// A point on the ground, whose height is 0 in the frame of the nearest pose.
struct CalibrationGround {
  int pose = 0;
  int point = 0;
};

/// The way between two successive poses, with the readings that cover it by half a second more.
struct CalibrationMotion {
  int from = 0;
  int to = 0;
  WheelModel model;  ///< as stated
  std::vector<WheelReading> readings;
};

struct CalibrationData {
  /// As stated, full-size images; the same in all drives. `exposed_after_s`: what the map has not
  /// yet moved its corners by; negative: what it moved them by beyond that.
  Rig rig;
  std::vector<CalibrationPose> poses;
  std::vector<Eigen::Vector3d> points;   ///< [m, map]
  std::vector<BundleObservation> views;  ///< full-size images, point by point
  std::vector<CalibrationGround> grounds;
  std::vector<CalibrationMotion> motions;

  [[nodiscard]] bool has_wheels() const { return !motions.empty(); }
};

/// A session of the map, and its wheels as stated; empty: not used.
struct CalibrationSession {
  bool used = true;  ///< false: its poses and views take no part
  std::optional<WheelModel> model;
  std::vector<WheelReading> readings;
};

struct CalibrationDataOptions {
  int per_image = 45;              ///< views of an image that take part
  std::size_t most_views = 80000;  ///< of all images; a long drive gives fewer an image
  int most_views_of_point = 12;    ///< spread evenly over the views of a landmark
  double stretch_m = 2.0;
};

/// Takes poses, landmarks and views from `map`, and the motions from the wheels of `sessions`.
/// `rig`: the cameras as stated, in the order of the map's. Landmarks with many views come first,
/// as far as their images need them.
[[nodiscard]] CalibrationData calibration_data(const Map& map,
                                               const Rig& rig,
                                               const std::vector<CalibrationSession>& sessions,
                                               const CalibrationDataOptions& options = {});

/// Sets the twists from the poses: the slope of a parabola through each pose and its neighbours.
void set_twists(std::vector<CalibrationPose>& poses);

}  // namespace roadbook
