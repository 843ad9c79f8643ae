#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/views/view_basis.hpp"

namespace roadbook {

// How much more the views of a camera say of its effects than they know, because errors come by
// landmarks rather than by views: a corner that is set beside the true one, or that is another one
// after half of its views, errs alike many times. The ratio of the score's variance summed by
// landmarks of the map to the model's, which is 1 for independent errors (cluster-robust variance:
// Liang and Zeger, Longitudinal data analysis using generalized linear models, 1986).
class LandmarkScatter {
 public:
  /// `data` is kept by reference.
  explicit LandmarkScatter(const ViewData& data);

  /// A row of a view: whitened residual, and its columns for the effects of its camera.
  void add(std::size_t observation,
           double residual,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns);

  /// Of each camera the mean over its effects, 1 where hardly more.
  [[nodiscard]] std::vector<double> ratios() const;

 private:
  static constexpr Eigen::Index kEffects = static_cast<Eigen::Index>(kCameraColumns.size());
  const ViewData& data_;
  Eigen::MatrixXd scores_;  ///< of each landmark, cameras side by side
  Eigen::RowVectorXd information_;
};

}  // namespace roadbook
