#pragma once

#include <cstdint>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/bundle_adjustment.hpp"

namespace roadbook {

// What a map holds of one drive, as a problem of least squares: where the cameras saw landmarks
// ("views"), how the wheels say the car moved from keyframe to keyframe, and how high the ground
// stands at the wheels.

/// Motion of the car at a keyframe: what the wheels' readings let expect (nominal), without them
/// from the poses.
struct ViewMoment {
  std::int64_t t_ns = 0;
  double t_s = 0.0;               ///< since the drive's first keyframe
  double speed = 0.0;             ///< [m/s], negative backwards
  double yaw_rate = 0.0;          ///< [rad/s]
  double acceleration = 0.0;      ///< [m/s^2]
  double yaw_acceleration = 0.0;  ///< [rad/s^2]
  double left_phase_rad = 0.0;
  double right_phase_rad = 0.0;
  bool read_by_wheels = false;  ///< rates and phases; else rates by the map's poses
};

struct ViewData {
  /// Nominal; observations sorted by landmark, their sigma_px a factor on their camera's noise.
  BundleProblem bundle;
  std::vector<ViewMoment> moments;  ///< of each pose
  /// Of the map, of each point. What several passes see of one landmark are several points: what a
  /// map joins is often not the same corner, and no effect needs the joint.
  std::vector<int> landmark;
  std::vector<int> keyframe;  ///< of the map, of each pose
  WheelModel wheels;
  bool has_wheels = false;
};

struct ViewDataOptions {
  /// Views of one image that take part, spread evenly: every one costs time, and neighbours say the
  /// same.
  int per_image = 15;
  /// Of one landmark in one pass: so many keyframes to either side of the nearest one (as in
  /// BundleStageOptions).
  int reach_keyframes = 20;
  double ground_ahead_m = 1.5;   ///< ground points nearer than this to the rear axle
  double ground_beside_m = 1.6;  ///< tell the height of the ground

  /// Throws InvalidOption.
  void check() const;
};

/// Session `session` of the map with the wheels of its drive. Deterministic.
[[nodiscard]] ViewData view_data(const Map& map,
                                 int session,
                                 const Drive& drive,
                                 const ViewDataOptions& options = {});

}  // namespace roadbook
