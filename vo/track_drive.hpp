#pragma once

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "vo/track_options.hpp"
#include "vo/visual_odometry.hpp"

namespace roadbook {

/// Runs visual odometry over a whole drive. Images are read and features detected in parallel,
/// ahead of the tracking; only the features stay in memory.
///
/// With wheels, frames nearer to the last keyframe than the spacing are not decoded, and a standing
/// car adds no keyframes. `masks`: one for each camera, of the half-size images, as in `OwnCar`; no
/// features are detected on the own car. The result does not depend on the number of threads.
/// Throws BadInput for a drive without cameras, Interrupted if `progress` returns false.
[[nodiscard]] VoResult track_drive(const Drive& drive,
                                   const std::vector<cv::Mat>& masks,
                                   const TrackDriveOptions& options,
                                   const Progress& progress = {});

}  // namespace roadbook
