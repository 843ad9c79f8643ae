#pragma once

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "vo/features.hpp"
#include "vo/visual_odometry.hpp"

namespace roadbook {

struct TrackDriveOptions {
  FeatureOptions features;
  VoOptions odometry;
  double max_gap_s = 1.0;  ///< longer without any image: nothing is assumed about the motion
  bool use_wheels = true;
  int num_threads = 0;  ///< 0: all cores

  /// Throws InvalidOption.
  void check() const;
};

/// Visual odometry of a whole drive: chooses keyframes, reads and describes their images in
/// parallel ahead of the tracking, and tracks. Images stream through; only features stay.
///
/// With wheels, frames nearer than the spacing are never decoded; a standing car adds nothing.
/// `masks`: of the half-size images, as in `OwnCar`; the own car has no features.
/// The result does not depend on the number of threads. Throws BadInput for a drive without
/// cameras, Interrupted when `progress` asks for it.
[[nodiscard]] VoResult track_drive(const Drive& drive,
                                   const std::vector<cv::Mat>& masks,
                                   const TrackDriveOptions& options,
                                   const Progress& progress = {});

/// The rig with the cameras of half-size images.
[[nodiscard]] Rig half_size(const Rig& rig);

}  // namespace roadbook
