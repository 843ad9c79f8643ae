#pragma once

#include <vector>

#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

// Systematic error of image corners, as a bound on chi-squared. Some corners are crossings of two
// edges that do not meet in space; they are misplaced in the same way in every pass. On rendered
// drives, at the true poses and calibration, this error reaches 0.1 px along an effect of one
// camera (docs/results/diagnosis_map.md). A smaller effect of one camera is therefore not separable
// from it. The errors of different cameras are independent, so the bound for an effect of the whole
// rig is lower.
class CornerErrors {
 public:
  CornerErrors(const ViewData& data, const ViewNoise& noise);

  /// Chi-squared that corner errors may produce along an effect of one camera.
  [[nodiscard]] double hide(std::size_t camera) const { return of_camera_[camera]; }
  /// The same along an effect that is equal for all cameras.
  [[nodiscard]] double hide_of_rig() const;
  /// The same along an effect of the catalogue; 0 for effects that wheels or ground determine.
  [[nodiscard]] double hide(const ViewCause& cause, const ViewBasis& basis) const;

 private:
  std::vector<double> of_camera_;
};

}  // namespace roadbook
