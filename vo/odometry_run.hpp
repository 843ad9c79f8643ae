#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "vo/track_options.hpp"

namespace roadbook {

// One run of visual odometry over a drive. `track_drive` may need several.

/// Features of all cameras in one frame.
using FrameFeatures = std::vector<Features>;

/// Reads the images of `frames[begin]` and up to `count - 1` more, and detects their features.
/// Cameras without an image have none. `cpu_ms`: receives the processor time of each frame.
[[nodiscard]] std::vector<FrameFeatures> describe_frames(const Drive& drive,
                                                         const std::vector<std::size_t>& frames,
                                                         std::size_t begin,
                                                         std::size_t count,
                                                         const std::vector<cv::Mat>& masks,
                                                         const TrackDriveOptions& options,
                                                         std::vector<double>* cpu_ms = nullptr);

/// Processor time [ms] that the calling thread has used.
[[nodiscard]] double thread_cpu_ms();

/// Runs odometry once, with `wheels` if not null. Where they are unknown the cameras work alone.
[[nodiscard]] VoResult run_odometry(const Drive& drive,
                                    const std::vector<cv::Mat>& masks,
                                    const TrackDriveOptions& options,
                                    const WheelOdometry* wheels,
                                    const Progress& progress);

}  // namespace roadbook
