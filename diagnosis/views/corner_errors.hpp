#pragma once

#include <vector>

#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

// Corners where edges cross that do not meet in space err alike in every pass: at the true poses
// and calibration of rendered drives the views of one camera err by up to 0.1 px along an effect of
// that camera (docs/results/diagnosis_map.md). What moves them by less is not told from that; along an
// effect of the rig half of it, of four cameras, which err apart.
class CornerErrors {
 public:
  CornerErrors(const ViewData& data, const ViewNoise& noise);

  /// Chi-squared that they may leave along an effect of one camera.
  [[nodiscard]] double hide(std::size_t camera) const { return of_camera_[camera]; }
  /// Along one of all cameras alike.
  [[nodiscard]] double hide_of_rig() const;
  /// Along a named cause; 0 where wheels or ground tell it.
  [[nodiscard]] double hide(const ViewCause& cause, const ViewBasis& basis) const;

 private:
  std::vector<double> of_camera_;
};

}  // namespace roadbook
