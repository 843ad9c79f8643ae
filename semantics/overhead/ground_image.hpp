#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "semantics/oriented_box.hpp"

namespace roadbook {

/// A picture of the ground from above, north up: what a detector looks at.
struct GroundImage {
  cv::Mat grey;                                      ///< 8 bit
  cv::Mat seen;                                      ///< 8 bit, 0 where nothing was seen; same size
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< outer corner of the first pixel [m]
  double resolution_m = 0.1;                         ///< side of a pixel

  /// Pixel coordinates (column, row; the first pixel's centre is 0, 0) of a place.
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector2d& p) const {
    return {(p.x() - corner.x()) / resolution_m - 0.5, (corner.y() - p.y()) / resolution_m - 0.5};
  }
};

/// The picture at about `resolution_m` a pixel, by areas; unseen ground takes the mean of what is
/// seen, so that it has no edges of its own but the border. Finer pictures only get coarser.
[[nodiscard]] GroundImage coarser(const GroundImage& image, double resolution_m);

/// `size` pixels of `pixel_m` metres, their middle at the box's centre, columns along its heading
/// and rows to its right. Unseen ground stays as in the picture; outside it is mean grey.
[[nodiscard]] cv::Mat upright_patch(const GroundImage& image,
                                    const Eigen::Vector2d& centre,
                                    double heading,
                                    double pixel_m,
                                    cv::Size size);

/// Share of the box that was seen, 0 to 1, from a grid of points.
[[nodiscard]] double seen_share(const GroundImage& image, const OrientedBox& box);

}  // namespace roadbook
