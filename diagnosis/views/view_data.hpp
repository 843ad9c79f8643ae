#pragma once

#include <cstdint>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

// One drive of a map as a least-squares problem: pixels of landmarks in the cameras ("views"),
// motions of the car from keyframe to keyframe by the wheels, and heights of the ground at the
// wheels.

/// Motion of the car at a keyframe, by the nominal wheels; by the poses where the wheels have no
/// readings.
struct ViewMoment {
  std::int64_t t_ns = 0;
  double t_s = 0.0;               ///< since the drive's first keyframe
  double speed = 0.0;             ///< [m/s], negative backwards
  double yaw_rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;      ///< [m/s^2]
  double yaw_acceleration = 0.0;  ///< [rad/s^2]
  double left_phase_rad = 0.0;
  double right_phase_rad = 0.0;
  bool read_by_wheels = false;  ///< else rates from the poses, no phases
};

struct ViewData {
  /// The nominal problem. Observations are sorted by landmark; their sigma_px is a factor on the
  /// noise of their camera.
  BundleProblem bundle;
  std::vector<ViewMoment> moments;  ///< of each pose
  /// For each point its landmark in the map. A landmark seen in several passes gives several
  /// points: the map may have joined different corners, and no effect needs the joint.
  std::vector<int> landmark;
  std::vector<int> keyframe;  ///< for each pose its keyframe in the map
  WheelModel wheels;
  bool has_wheels = false;
};

struct ViewDataOptions {
  /// Views used of each image, spread evenly over the image. More views cost time and add little.
  int per_image = 15;
  /// Views used of a landmark in one pass: those within so many keyframes of the nearest one, to
  /// either side (as in BundleStageOptions).
  int reach_keyframes = 20;
  double ground_ahead_m =
      1.5;  ///< a ground point determines the height of the ground if it lies within
  double ground_beside_m = 1.6;  ///< this distance ahead of and beside the middle of the rear axle

  /// Throws InvalidOption.
  void check() const;
};

/// Builds the problem from session `session` of the map and the wheel readings of its drive.
/// Deterministic.
[[nodiscard]] ViewData view_data(const Map& map,
                                 int session,
                                 const Drive& drive,
                                 const ViewDataOptions& options = {});

}  // namespace roadbook
