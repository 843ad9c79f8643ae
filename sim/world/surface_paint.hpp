#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "base/random.hpp"
#include "sim/scenario/scenario.hpp"

namespace roadbook {

/// A wall of the given size, row 0 at its foot: formwork, bricks, panels or plaster, dirt, stains,
/// pipes, and posters and signs where wanted. Brightness includes the light that falls on it.
[[nodiscard]] cv::Mat paint_wall(SurfaceTexture texture,
                                 double length_m,
                                 double height_m,
                                 double texel_m,
                                 int posters,
                                 bool windows,
                                 Random& random);
/// A ceiling: concrete between beams, lamps, pipes, cables. Row 0 at the low y side.
[[nodiscard]] cv::Mat paint_ceiling(const CeilingSpec& ceiling,
                                    const Eigen::Vector2d& low,
                                    const Eigen::Vector2d& high,
                                    double texel_m,
                                    Random& random);
/// One side of a pillar, `number` painted on it, with the black and yellow foot of car parks.
[[nodiscard]] cv::Mat paint_pillar(
    double width_m, double height_m, double texel_m, int number, Random& random);
/// Sky over buildings and trees, 360 by 90 degrees: u by azimuth, row 0 at the horizon.
[[nodiscard]] cv::Mat paint_sky(Random& random);

}  // namespace roadbook
