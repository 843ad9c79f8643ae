#pragma once

#include <array>
#include <vector>

#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

/// Residuals with all catalogued effects free (the saturated model), and how much of the noise of
/// each channel they retain.
struct Saturated {
  std::vector<std::vector<double>> squares;  ///< squared residuals of each channel
  std::vector<double>
      redundancy;  ///< redundancy (trace of the residual projection) of each channel
  std::vector<double> view_square;  ///< of each observation: squares of x and y, summed
  std::vector<double>
      scatter;  ///< variance inflation of each camera: LandmarkScatter, ImageScatter
  std::array<double, 6>
      sway{};  ///< variance inflation of each axis of the motions: motion_variance_inflation
};

/// One Gauss-Newton step with all effects free, regularised by their priors about the sizes in
/// `known`. `system` must be linearised at `point`, which moves to the new estimate.
[[nodiscard]] Saturated saturate(const ViewSystem& system,
                                 const std::vector<ViewCause>& causes,
                                 const ViewBasis& basis,
                                 const ViewData& data,
                                 const EffectSizes& known,
                                 ViewPoint& point);

/// Updates `noise` by the residuals of a saturated fit at `noise`: the scale of motions and ground;
/// scale and degrees of freedom (`freedom`, one a camera) of the Student t noise of views.
void renew_noise(const Saturated& saturated,
                 const ViewData& data,
                 ViewNoise& noise,
                 std::vector<double>& freedom);

}  // namespace roadbook
