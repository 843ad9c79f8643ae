#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/types.hpp>
#include <vector>

#include "semantics/oriented_box.hpp"

namespace roadbook {

using QuadOutline = std::array<Eigen::Vector2d, 4>;  ///< corners in turn

/// The view of level ground through a camera without distortion, and the objects of the outlines
/// from which the view was estimated.
struct FittedGround {
  Eigen::Matrix3d H_image_ground;  ///< of places [m, 1] to pixels [px, 1]
  std::vector<OrientedBox> boxes;  ///< of the outlines: their middles and headings, of one size
  double side_spread = 0.0;        ///< median of |ln(side / usual side)|: 0.1 is about 10 %
};

/// Estimates focal length, tilt and roll from outlines of rectangles of one size, with area
/// `area_m2` each. It minimises the sum of absolute logarithms of the sides over their medians, and
/// of absolute cosines of the corners. This norm tolerates wrong outlines. The principal point is
/// the picture's middle. Throws InvalidOption for fewer than 4 outlines.
[[nodiscard]] FittedGround fit_ground_view(const std::vector<QuadOutline>& outlines,
                                           cv::Size picture,
                                           double area_m2);

}  // namespace roadbook
