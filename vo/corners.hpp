#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace roadbook {

// The corners that BRISK's detector finds on a single scale (AGAST 9-16 with non-maximum
// suppression). OpenCV's vectorised FAST finds them, because it tests the same arcs. Only corners
// that are kept are refined to sub-pixel positions.

/// Strength of a corner at pixel (x, y), at least 3 px inside the image: the largest threshold at
/// which nine neighbours in a row on the circle of 16 are all brighter, or all darker, than the
/// centre (Rosten, Porter, Drummond 2010, section 3.2). 0 if it is no corner.
[[nodiscard]] int corner_score(const cv::Mat& image, int x, int y);

/// Finds corners at whole pixels; `response` is their strength, above `threshold` [grey levels].
/// `image` is 8-bit grey.
[[nodiscard]] std::vector<cv::KeyPoint> find_corners(const cv::Mat& image, int threshold);

/// Returns the sub-pixel position of a corner: the peak of the parabola through the strengths of
/// the 3 x 3 pixels around it, at most one pixel away (Leutenegger, Chli, Siegwart 2011, section
/// 3.1).
[[nodiscard]] cv::Point2f refine_corner(const cv::Mat& image, const cv::Point2f& corner);

}  // namespace roadbook
