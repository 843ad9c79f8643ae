#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "semantics/oriented_box.hpp"

namespace roadbook {

/// Overhead image as a detector uses it, north up.
struct GroundImage {
  cv::Mat grey;                                      ///< 8 bit
  cv::Mat seen;                                      ///< 8 bit, same size; 0: not observed
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< outer corner of the first pixel [m]
  double resolution_m = 0.1;                         ///< side of a pixel

  /// Pixel coordinates (column, row) of a map point; the centre of the first pixel is (0, 0).
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector2d& p) const {
    return {(p.x() - corner.x()) / resolution_m - 0.5, (corner.y() - p.y()) / resolution_m - 0.5};
  }
};

/// Reduces the image to about `resolution_m` per pixel by averaging areas. Unobserved pixels take
/// the mean grey of observed ones, so that only the border of the observed area has an edge. An
/// image that is already coarser is not enlarged.
[[nodiscard]] GroundImage coarser(const GroundImage& image, double resolution_m);

/// Cuts a turned patch: `size` pixels of `pixel_m` metres centred at `centre`, columns along
/// `heading`, rows to its right. Outside the image the patch is mean grey.
[[nodiscard]] cv::Mat upright_patch(const GroundImage& image,
                                    const Eigen::Vector2d& centre,
                                    double heading,
                                    double pixel_m,
                                    cv::Size size);

/// Share of the box that was observed, 0 to 1, sampled on a grid of points.
[[nodiscard]] double seen_share(const GroundImage& image, const OrientedBox& box);

}  // namespace roadbook
