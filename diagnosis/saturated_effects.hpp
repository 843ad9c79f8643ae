#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/motion_library.hpp"
#include "diagnosis/normal_equations.hpp"

namespace roadbook {

/// Named effects held by their plausible sizes: what the noise may not swallow.
struct HeldEffects {
  Library library;
  Eigen::VectorXd precision;
};

/// With the plainer terms of the grammar on demand.
[[nodiscard]] HeldEffects saturated_library(const Observations& obs,
                                            const MotionPoint& point,
                                            bool with_terms = false);

/// Weights of the sides that give the residual with the effects fitted.
[[nodiscard]] std::vector<double> saturated_weights(const Normal& normal,
                                                    const HeldEffects& s,
                                                    const Innovations& in);

}  // namespace roadbook
