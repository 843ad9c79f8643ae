#pragma once

#include <vector>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// How bright landmarks look, from image to image and from camera to camera.

struct BrightnessSample {
  int landmark = 0;
  int camera = 0;
  double t_s = 0.0;           ///< since the session's first keyframe
  double log_grey = 0.0;      ///< of the mean grey level about the corner
  double radius = 0.0;        ///< from the image's middle, over half its width
  double log_distance = 0.0;  ///< of the landmark [m]
};

struct BrightnessOptions {
  /// Instants whose images are read, in bursts of a few keyframes some way apart, so that landmarks
  /// are seen by several: images are what costs time.
  int bursts = 15;
  int burst_keyframes = 4;
  int step_keyframes = 4;
  int patch_px = 9;          ///< width of the square of which the mean is taken
  double darkest = 12.0;     ///< grey levels below are noise,
  double brightest = 240.0;  ///< those above may be clipped
  int num_threads = 1;       ///< 0: all cores; the samples are the same for any number

  /// Throws InvalidOption.
  void check() const;
};

/// Samples of landmarks seen at least twice, landmark by landmark; none where the drive has no
/// images.
[[nodiscard]] std::vector<BrightnessSample> brightness_samples(
    const Map& map, int session, const Drive& drive, const BrightnessOptions& options = {});

}  // namespace roadbook
