#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/views/view_basis.hpp"

namespace roadbook {

// Variance inflation of a camera's effects by errors that are common to an image. A camera that
// shakes, or whose time stamps jitter, shifts all views of an image by about the same amount, and
// those of neighbouring images too. Intervals that assume independent views are then too narrow.
//
// The score of an effect is the sum over all rows of residual times derivative of the row by the
// size of the effect. Two estimates of its variance are compared for each effect:
//   grouped: rows are summed by image, and images are correlated over kImagesAlike frames with
//            Bartlett weights (Newey and West 1987);
//   independent: sum of the squares of the single rows.
// The fit of poses, landmarks and effects absorbs a part of common errors, on a short drive nearly
// all of it, which lowers the ratio grouped / independent. Simulated independent errors that went
// through the same fit have a ratio lowered by the same factor. So the ratio of the residuals is
// divided by the mean ratio of the simulated errors.
class ImageScatter {
 public:
  static constexpr Eigen::Index kImagesAlike = 40;

  /// `data` must outlive this object. `draws`: number of simulated sets of independent errors.
  ImageScatter(const ViewData& data, Eigen::Index draws);

  /// Adds one row of a view (x or y of observation `observation` of `data.bundle`). `left`: 1 +
  /// draws whitened values [standard deviations] after the fit: the residual, then the simulated
  /// error of each draw. `columns`: whitened derivatives of the row by the effects of its camera,
  /// in the order of kCameraColumns.
  void add(std::size_t observation,
           const Eigen::Ref<const Eigen::RowVectorXd>& left,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns);

  /// Variance inflation of each camera, the mean over its effects. It is 1 if it exceeds 1 by less
  /// than two standard errors, and for a camera without rows.
  [[nodiscard]] std::vector<double> ratios() const;

 private:
  static constexpr Eigen::Index kEffects = static_cast<Eigen::Index>(kCameraColumns.size());
  /// Ratio of grouped to independent score variance of each camera. `side`: 0 for the residuals, k
  /// for draw k.
  [[nodiscard]] Eigen::VectorXd shared(std::size_t side) const;

  const ViewData& data_;
  std::vector<Eigen::MatrixXd>
      scores_;  ///< of each side: scores summed by image, one row a pose, one column an effect
  Eigen::MatrixXd one_by_one_;  ///< sums of squared scores of single rows, one row a side
};

}  // namespace roadbook
