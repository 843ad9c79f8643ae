#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "sim/scenario/scenario_spec.hpp"

namespace roadbook {

// Brushes for textures that are computed once: exact in place, because rendered markings are
// compared with their truth.

/// A drawing surface over a rectangle of the plane.
struct Canvas {
  cv::Mat image;        ///< 8 bit
  Eigen::Vector2d low;  ///< corner of texel (0, 0) [m]
  double texel_m = 0.01;

  /// Texel coordinates (centre of the first: 0, 0) of a place.
  [[nodiscard]] Eigen::Vector2d texel(const Eigen::Vector2d& place) const {
    return (place - low) / texel_m - Eigen::Vector2d::Constant(0.5);
  }
};

using Polygon = std::vector<Eigen::Vector2d>;

/// Rectangle along `from` - `to`, `width` wide, the line in its middle.
[[nodiscard]] Polygon strip(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double width);
/// Rectangle by centre, heading and size along its own axes.
[[nodiscard]] Polygon rectangle(const Eigen::Vector2d& centre,
                                double heading,
                                const Eigen::Vector2d& size);

/// Blends `value` into the convex polygon with the exact share of every texel, times `opacity`;
/// the edge is `soft_m` wide (at least one texel). Either orientation.
void fill_convex(
    Canvas& canvas, const Polygon& polygon, double value, double opacity, double soft_m = 0.0);
/// Sets the texels whose centre is inside: for rasters of class numbers, which must not be mixed.
void stamp_convex(Canvas& canvas, const Polygon& polygon, std::uint8_t value);
/// Multiplies instead of blending: shadows. `factor` inside, 1 outside, `soft_m` between.
void shade_convex(Canvas& canvas, const Polygon& polygon, double factor, double soft_m);
/// Text with its middle at `centre`, letters `height_m` high, reading direction `heading`.
void draw_text(Canvas& canvas,
               const std::string& text,
               const Eigen::Vector2d& centre,
               double heading,
               double height_m,
               double value,
               double opacity);

/// Copies what is painted on the first bay to the other bays.
void repeat_bay(const BaySpec& bays, Canvas& canvas);

/// A tile that repeats without seam: stones and pits of a fine surface, mean 128.
[[nodiscard]] cv::Mat speckle_tile(
    int size, int grains, int smallest, int largest, double contrast, Random& random);

}  // namespace roadbook
