#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

/// Noise effects of the cameras at the final model: the share of outliers of each camera
/// ("cam1.outliers"), and the growth of the variance of all views with speed and turn rate
/// ("cam.variance(speed)"). Each is reported if its p-value, corrected for all of them, is below
/// 0.01.
[[nodiscard]] std::vector<NoiseCause> view_noise_causes(const ViewFit& fit,
                                                        const ViewSystem& system,
                                                        const Eigen::MatrixXd& sums);

}  // namespace roadbook
