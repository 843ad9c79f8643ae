#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <span>
#include <vector>

#include "vo/descriptor.hpp"

namespace roadbook {

// BRISK descriptions of corners [Leutenegger, Chli and Siegwart, BRISK: Binary robust invariant
// scalable keypoints, ICCV 2011]: grey values of 60 places on five rings, each the mean of a box;
// the pairs far apart give a direction, and the pairs close together in the ring turned by it are
// the bits. All corners have the size that BRISK's detector gives its finest scale (12 pixels).

struct DescribedCorners {
  std::vector<int> corners;  ///< indices of those described, ascending
  std::vector<Descriptor> descriptors;
};

/// Distance from the image border [pixels] that the rings of a corner need.
[[nodiscard]] float description_border_px();

/// Describes corners [pixels] of an 8-bit grey image. Corners whose rings leave the image are left
/// out. The descriptors are those of cv::BRISK, bit for bit. Safe to call concurrently.
[[nodiscard]] DescribedCorners describe_corners(const cv::Mat& image,
                                                std::span<const cv::Point2f> corners);

}  // namespace roadbook
