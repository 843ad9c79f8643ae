#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Visual odometry of a rig of cameras, frame by frame. It tracks corners from keyframe to keyframe.
// It estimates the motion from the triangulated corners, and from the wheels if there are any; then
// it triangulates the other corners. Without wheels it starts from two views and takes the scale
// from the cameras' height over the ground.

struct VoOptions {
  double spacing_m = 0.20;          ///< between keyframes [metric-semantic maps, section IV-B]
  double turn_rad = 0.0873;         ///< heading change that also makes a keyframe: 5 degrees
  double feature_sigma_px = 0.6;    ///< of a corner, half-size image
  double inlier_px = 2.5;           ///< half-size image
  double min_parallax_rad = 0.017;  ///< that a corner needs to be triangulated
  int min_inliers = 20;  ///< with fewer, the motion is taken from the wheels, or is unknown
  int max_skipped = 2;   ///< keyframes a track may miss before it ends
  /// Divides the information of the estimated motions, because errors of many corners are
  /// correlated.
  double information_discount = 25.0;

  /// Throws InvalidOption.
  void check() const;
};

enum class VoOutcome {
  kKeyframe,  ///< this frame, or the frame held before it, became a keyframe
  kTooClose,  ///< too near to the last keyframe; held until the next frame shows which is nearer
  kWaiting,   ///< the motion is not known yet (first frames without wheels)
};

/// A frame offered to visual odometry.
struct VoFrame {
  std::size_t frame = 0;  ///< index in the drive
  std::int64_t t_ns = 0;
  std::vector<Features> features;  ///< per camera, of the half-size images
  /// Motion since the last keyframe by the wheels; empty if unknown.
  std::optional<PlanarMotion> wheels;
  bool after_gap = false;  ///< too much time has passed since the last frame: start a new segment
};

/// Runs visual odometry on frames in ascending order of time. Not for concurrent use.
class VisualOdometry {
 public:
  /// `half_rig`: the rig with cameras of the half-size images.
  VisualOdometry(Rig half_rig, const VoOptions& options);
  ~VisualOdometry();
  VisualOdometry(VisualOdometry&&) noexcept;
  VisualOdometry& operator=(VisualOdometry&&) noexcept;

  /// Processes one frame and returns what became of it.
  VoOutcome add(VoFrame frame);
  /// Stamp of the newest keyframe, if there is one.
  [[nodiscard]] std::optional<std::int64_t> last_keyframe_ns() const;
  /// Returns all keyframes and tracks; the object is empty afterwards.
  [[nodiscard]] VoResult finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadbook
