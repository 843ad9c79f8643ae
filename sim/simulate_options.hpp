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
  bool images = true;           ///< false: writes all streams except images
  bool class_images = false;    ///< `segmentationN`: class of every pixel (SurfaceClass)
  bool range_images = false;    ///< `truth/range/camN`: 16-bit PNG, millimetres from the camera
  bool ranges = false;          ///< `range0`: readings of a scanner; its effects switch it on
  bool detections = false;      ///< `detector0`: detected people; its effects switch it on
  bool temperature = false;     ///< of the tyres, in `friction0`; its effect switches it on
  double max_duration_s = 0.0;  ///< ends the drive early; 0: the whole drive
  std::map<std::string, double> camera_dies_s;  ///< by camera: time after which it gives no images
  int num_threads = 0;     ///< 0: all cores; the drive is the same for any number
  bool overwrite = false;  ///< replaces an existing drive

  /// Throws InvalidOption or BadInput (effects).
  void check() const;
};

}  // namespace roadbook
