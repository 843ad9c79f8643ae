#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

/// Outliers of each camera ("cam1.outliers", share of views), and how the variance of all views
/// grows with speed and turn rate ("cam.variance(speed)"), at the final model. Named below p = 0.01
/// corrected for all of them.
[[nodiscard]] std::vector<NoiseCause> view_noise_causes(const ViewFit& fit,
                                                        const ViewSystem& system,
                                                        const Eigen::MatrixXd& sums);

}  // namespace roadbook
