#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/friction/friction_noise_model.hpp"
#include "diagnosis/numerics/place_basis.hpp"

namespace roadbook {

/// Estimates the noise with the coefficients of `mean` free; those after the first `flat` have a
/// standard normal prior. A part of the noise enters the model only if the likelihood clearly
/// supports it. The spatial bias is estimated only if `places`.
[[nodiscard]] FrictionNoise friction_noise(const std::vector<FrictionSample>& samples,
                                           PlaceBases& bases,
                                           const FrictionMean& mean,
                                           Eigen::Index flat,
                                           bool places = true);

}  // namespace roadbook
