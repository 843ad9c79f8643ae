#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/views/view_basis.hpp"

namespace roadbook {

// How much more the views of a camera say of its effects than they know, because errors come by
// images rather than by views: of a camera that trembles, or whose stamps do, all views of an image
// err alike, and those of the images about it. The ratio of the score's variance with what images
// up to kImagesAlike apart share to that of views one by one (Newey and West, A simple, positive
// semi-definite, heteroskedasticity and autocorrelation consistent covariance matrix, 1987), over
// the same of independent errors that have gone through the same fit: poses, landmarks and effects
// take up most of what views share, of a short drive nearly all.
class ImageScatter {
 public:
  static constexpr Eigen::Index kImagesAlike = 40;

  /// `data` is kept by reference. `draws`: independent errors beside the residual.
  ImageScatter(const ViewData& data, Eigen::Index draws);

  /// A row of a view: what is left of the residual and of each draw, and its columns for the
  /// effects of its camera.
  void add(std::size_t observation,
           const Eigen::Ref<const Eigen::RowVectorXd>& left,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns);

  /// Of each camera the mean over its effects, 1 where it is not beyond twice its own scatter.
  [[nodiscard]] std::vector<double> ratios() const;

 private:
  static constexpr Eigen::Index kEffects = static_cast<Eigen::Index>(kCameraColumns.size());
  /// Of one side, of each camera.
  [[nodiscard]] Eigen::VectorXd shared(std::size_t side) const;

  const ViewData& data_;
  std::vector<Eigen::MatrixXd> scores_;  ///< of each side: a row a pose, cameras side by side
  Eigen::MatrixXd one_by_one_;           ///< sums of squares, a row a side
};

}  // namespace roadbook
