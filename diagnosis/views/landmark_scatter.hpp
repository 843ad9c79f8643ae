#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/views/view_basis.hpp"

namespace roadbook {

// Variance inflation of a camera's effects by errors that are common to a landmark. A corner that
// is misplaced, or whose track continues on another corner, has the same error in many views.
//
// For each effect of the camera, the variance of the score with views grouped by landmark of the
// map is divided by the variance that the noise model predicts. It is 1 for independent errors.
// Source: Liang and Zeger 1986 (cluster-robust variance).
class LandmarkScatter {
 public:
  /// `data` must outlive this object.
  explicit LandmarkScatter(const ViewData& data);

  /// Adds one row of a view: its whitened residual, and its derivatives by the effects of its
  /// camera in the order of kCameraColumns.
  void add(std::size_t observation,
           double residual,
           const Eigen::Ref<const Eigen::RowVectorXd>& columns);

  /// Inflation of each camera: mean over its effects; 1 if it is below 1.15.
  [[nodiscard]] std::vector<double> ratios() const;

 private:
  static constexpr Eigen::Index kEffects = static_cast<Eigen::Index>(kCameraColumns.size());
  const ViewData& data_;
  Eigen::MatrixXd scores_;  ///< one row a landmark, the effects of all cameras side by side
  Eigen::RowVectorXd information_;
};

}  // namespace roadbook
