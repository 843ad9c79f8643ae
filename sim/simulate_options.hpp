#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "sensors/effects.hpp"

namespace roadbook {

/// What to record on a simulated drive.
struct SimulateOptions {
  std::uint64_t seed = 1;       ///< of the drive: driver, people, noise; not of the place
  EffectSizes effects;          ///< imperfections that are switched on
  bool noise = true;            ///< of images, wheels, IMU, friction; and the driver's wander
  bool images = true;           ///< false: all but the images, at once
  bool class_images = false;    ///< `segmentationN`: what every pixel shows (SurfaceClass)
  bool range_images = false;    ///< `truth/range/camN`: 16-bit PNG, millimetres from the camera
  bool ranges = false;          ///< `range0`: a scanner's readings; also where its effects are on
  bool detections = false;      ///< `detector0`: of people; also where its effects are on
  bool temperature = false;     ///< of the tyres in `friction0`; also where its effect is on
  double max_duration_s = 0.0;  ///< ends the drive early; 0: whole
  std::map<std::string, double> camera_dies_s;  ///< by camera: no images from then on
  int num_threads = 0;     ///< 0: all cores; the drive is the same for any number
  bool overwrite = false;  ///< replaces a drive that is there

  /// Throws InvalidOption or BadInput (effects).
  void check() const;
};

}  // namespace roadbook
