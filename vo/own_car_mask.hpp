#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "drive/drive.hpp"

namespace roadbook {

/// Masks of the half-size images, one a camera: 0 where the own car is seen, 255 elsewhere; an
/// empty Mat where nothing is to be masked.
///
/// A file `camN/mask.png` in the drive (any size, 0: own car) is taken as it is. Otherwise the mask
/// is found from images spread over the drive: what has structure but never changes while
/// everything else does belongs to the car. Deterministic.
[[nodiscard]] std::vector<cv::Mat> own_car_masks(const Drive& drive, int num_threads);

}  // namespace roadbook
