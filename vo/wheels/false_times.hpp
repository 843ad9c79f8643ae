#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <utility>
#include <vector>

#include "drive/drive.hpp"
#include "vo/track_options.hpp"

namespace roadbook {

/// Returns the times [ns] in which the wheels stand but the images move: ascending, apart from each
/// other. Compares two frames every 0.4 s of each standstill of the wheels; a standing car's
/// images show the same corners at the same pixels. Other road users that move do not matter as
/// long as they cover less than half of the corners.
[[nodiscard]] std::vector<std::pair<std::int64_t, std::int64_t>> false_standstills(
    const Drive& drive,
    const std::vector<cv::Mat>& masks,
    const TrackDriveOptions& options,
    const WheelOdometry& wheels);

/// Returns the times [ns] between two readings of the wheels that no car can drive: a lost or a
/// wrong count.
[[nodiscard]] std::vector<std::pair<std::int64_t, std::int64_t>> impossible_times(
    const WheelModel& model, const std::vector<WheelReading>& readings);

}  // namespace roadbook
