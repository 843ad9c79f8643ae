#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/view_basis.hpp"

namespace roadbook {

// How much more the views of a camera say of its effects than they know, because errors come by
// images rather than by views: of a camera that trembles, or whose stamps do, all views of an image
// err alike, and those of the images about it. The ratio of the score's variance with what images
// up to kImagesAlike apart share to the model's, which is below 1 for independent errors: poses and
// landmarks take up part of what views share (Newey and West, A simple, positive semi-definite,
// heteroskedasticity and autocorrelation consistent covariance matrix, 1987).
class ImageScatter {
 public:
  static constexpr Eigen::Index kImagesAlike = 40;

  /// `data` is kept by reference.
  explicit ImageScatter(const ViewData& data);

  /// A row of a view: whitened residual, and its columns for the effects of its camera.
  void add(std::size_t observation,
           double residual,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns);

  /// Of each camera the mean over its effects, 1 at least.
  [[nodiscard]] std::vector<double> ratios() const;

 private:
  static constexpr Eigen::Index kEffects = static_cast<Eigen::Index>(kCameraColumns.size());
  const ViewData& data_;
  Eigen::MatrixXd scores_;  ///< of each pose, cameras side by side
  Eigen::RowVectorXd information_;
};

}  // namespace roadbook
