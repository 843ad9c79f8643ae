#pragma once

#include <vector>

#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

// Brightness of landmarks in the images of several keyframes and cameras.

struct BrightnessSample {
  int landmark = 0;
  int camera = 0;
  double t_s = 0.0;           ///< since the session's first keyframe
  double log_grey = 0.0;      ///< log of the mean grey level around the corner
  double radius = 0.0;        ///< distance from the image's middle over half the image width
  double log_distance = 0.0;  ///< log of the distance of the landmark in metres
};

struct BrightnessOptions {
  /// Number of bursts of neighbouring keyframes whose images are read, so that several keyframes
  /// see each landmark. Reading images dominates the cost.
  int bursts = 15;
  int burst_keyframes = 4;
  int step_keyframes = 4;
  int patch_px = 9;          ///< width of the square patch
  double darkest = 12.0;     ///< darker patches are dominated by noise
  double brightest = 240.0;  ///< brighter patches may be saturated
  int num_threads = 1;       ///< 0 for all cores; the samples do not depend on it

  /// Throws InvalidOption.
  void check() const;
};

/// Samples of landmarks seen at least twice, grouped by landmark; empty if the drive has no images.
[[nodiscard]] std::vector<BrightnessSample> brightness_samples(
    const Map& map, int session, const Drive& drive, const BrightnessOptions& options = {});

}  // namespace roadbook
