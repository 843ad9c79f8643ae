#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/views/view_basis.hpp"

namespace roadbook {

// Variance inflation of a camera's effects by errors that are common to an image. A camera that
// shakes, or whose time stamps jitter, moves all views of an image alike, and those of neighbouring
// images.
//
// For each effect of the camera, the variance of the score with images grouped over kImagesAlike
// frames (Newey and West 1987) is divided by the sum of squares of independent views. The same
// ratio of simulated independent errors that went through the same fit removes the influence of the
// fit: poses, landmarks and effects absorb much of a common error, on a short drive nearly all of
// it.
class ImageScatter {
 public:
  static constexpr Eigen::Index kImagesAlike = 40;

  /// `data` must outlive this object. `draws`: number of simulated independent errors.
  ImageScatter(const ViewData& data, Eigen::Index draws);

  /// Adds one row of a view. `left`: residual and one value a draw, all after the fit. `columns`:
  /// the row's derivatives by the effects of its camera, in the order of kCameraColumns.
  void add(std::size_t observation,
           const Eigen::Ref<const Eigen::RowVectorXd>& left,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns);

  /// Inflation of each camera: mean over its effects; 1 if it exceeds 1 by less than two standard
  /// errors.
  [[nodiscard]] std::vector<double> ratios() const;

 private:
  static constexpr Eigen::Index kEffects = static_cast<Eigen::Index>(kCameraColumns.size());
  /// Ratio of grouped to independent score variance of each camera, for one side (0: residual, then
  /// draws).
  [[nodiscard]] Eigen::VectorXd shared(std::size_t side) const;

  const ViewData& data_;
  std::vector<Eigen::MatrixXd>
      scores_;  ///< of each side: one row a pose, the effects of all cameras side by side
  Eigen::MatrixXd one_by_one_;  ///< sums of squared scores of single views, one row a side
};

}  // namespace roadbook
