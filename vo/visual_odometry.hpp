#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Visual odometry of a rig of cameras, frame by frame: tracks corners from keyframe to keyframe,
// estimates the motion from those whose place is known (and the wheels, where there are any), and
// triangulates the others. Without wheels it starts from two views and takes the scale from the
// cameras' height over the ground.

struct VoOptions {
  double spacing_m = 0.20;        ///< between keyframes [metric-semantic maps, section IV-B]
  double turn_rad = 0.0873;       ///< heading change that also makes a keyframe: 5 degrees
  double feature_sigma_px = 0.6;  ///< of a corner, half-size image
  double inlier_px = 2.5;         ///< half-size image
  double min_parallax_rad = 0.017;
  int min_inliers = 20;  ///< fewer: the frame's motion is taken from the wheels, or lost
  int max_skipped = 2;   ///< keyframes a track may miss before it ends
  /// Far smaller than what many correlated corners pretend: standard deviations are widened by
  /// this.
  double information_discount = 25.0;

  /// Throws InvalidOption.
  void check() const;
};

enum class VoOutcome {
  kKeyframe,  ///< the frame, or the one held before it, became a keyframe
  kTooClose,  ///< has not moved far enough: held until the next frame shows which one is nearer
  kWaiting,   ///< no motion known yet (first frames without wheels)
};

/// A frame offered to visual odometry.
struct VoFrame {
  std::size_t frame = 0;
  std::int64_t t_ns = 0;
  std::vector<Features> features;  ///< per camera
  /// Motion since the last keyframe by the wheels, where they know it.
  std::optional<PlanarMotion> wheels;
  bool after_gap = false;  ///< too much time has passed since the last frame to continue
};

class VisualOdometry {
 public:
  /// `half_rig`: the rig with cameras of the half-size images.
  VisualOdometry(Rig half_rig, const VoOptions& options);
  ~VisualOdometry();
  VisualOdometry(VisualOdometry&&) noexcept;
  VisualOdometry& operator=(VisualOdometry&&) noexcept;

  VoOutcome add(VoFrame frame);
  /// Stamp of the newest keyframe, if there is one.
  [[nodiscard]] std::optional<std::int64_t> last_keyframe_ns() const;
  /// Hands over everything; the object is empty afterwards.
  [[nodiscard]] VoResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadbook
