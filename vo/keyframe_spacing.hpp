#pragma once

namespace roadbook {

/// Chooses keyframes at a wanted spacing from the frames of a camera.
///
/// The keyframe is the frame nearest to the spacing, not the next one beyond it: at 2.4 m/s and
/// 12.5 images a second these are 0.19 m and 0.38 m. The distance of a keyframe from its wanted
/// place is carried to the next one, up to a quarter of the spacing. So the mean spacing stays near
/// the wanted one, and no gap grows beyond what the distance of frames requires.
class KeyframeSpacing {
 public:
  /// `spacing_m` > 0, `turn_rad` > 0: a turn that also makes a keyframe.
  KeyframeSpacing(double spacing_m, double turn_rad) : spacing_m_(spacing_m), turn_rad_(turn_rad) {}

  /// Returns the progress of a frame to the next keyframe: 0 at the last keyframe, 1 at the wanted
  /// position of the next one. The frame lies `distance_m` from the last keyframe and is turned by
  /// `turn_rad` against it.
  [[nodiscard]] double progress(double distance_m, double turn_rad) const;
  /// Of two frames, one short of the wanted position of the next keyframe and one beyond it,
  /// returns whether the first becomes the keyframe. It does if it is nearer to that position, and
  /// at least half of the spacing away from the last keyframe. Arguments: `progress` of both.
  [[nodiscard]] static bool first_is_nearer(double progress_short, double progress_beyond) {
    return progress_short >= 0.5 && 1.0 - progress_short <= progress_beyond - 1.0;
  }

  /// Call when a frame at this distance and turn from the last keyframe becomes a keyframe.
  /// `had_choice`: there was a frame between the two keyframes.
  void taken(double distance_m, double turn_rad, bool had_choice);
  /// Call when the motion from the last keyframe is unknown: no distance is carried over.
  void restart() { carried_m_ = 0.0; }

 private:
  double spacing_m_;
  double turn_rad_;
  double carried_m_ = 0.0;
};

}  // namespace roadbook
