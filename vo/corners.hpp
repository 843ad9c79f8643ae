#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace roadbook {

// The corners that BRISK's detector finds on a single scale (AGAST 9-16 with non-maximum
// suppression), by OpenCV's vectorised FAST, which tests the same arcs; the place within the pixel
// is refined only for the corners that are kept.

/// Strength of a corner at pixel (x, y), at least 3 px inside the image: the largest threshold at
/// which nine neighbours in a row on the circle of 16 are all brighter, or all darker, than the
/// centre (Rosten, Porter, Drummond 2010, section 3.2). 0 if it is no corner.
[[nodiscard]] int corner_score(const cv::Mat& image, int x, int y);

/// Corners at whole pixels, `response` their strength. `image` is 8 bit grey.
[[nodiscard]] std::vector<cv::KeyPoint> find_corners(const cv::Mat& image, int threshold);

/// The peak of the parabola through the strengths of the 3 x 3 pixels around a corner, at most one
/// pixel away (Leutenegger, Chli, Siegwart 2011, section 3.1).
[[nodiscard]] cv::Point2f refine_corner(const cv::Mat& image, const cv::Point2f& corner);

}  // namespace roadbook
