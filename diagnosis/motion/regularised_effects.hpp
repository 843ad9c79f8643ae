#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/motion/motion_library.hpp"
#include "diagnosis/streams/normal_equations.hpp"

namespace roadbook {

/// Columns of effects that the noise must not absorb, and for each the inverse square of its
/// plausible size, which regularises it.
struct HeldEffects {
  Library library;
  Eigen::VectorXd precision;
};

/// The named effects, and these places where the wheels slip, whose discs may be off by a metre;
/// `with_terms`: and the plainer terms of the grammar.
[[nodiscard]] HeldEffects saturated_library(const Observations& obs,
                                            const MotionPoint& point,
                                            const std::vector<Accepted>& places = {},
                                            bool with_terms = false);

/// Weights of the sides that give the residual with the effects fitted.
[[nodiscard]] std::vector<double> saturated_weights(const Normal& normal,
                                                    const HeldEffects& s,
                                                    const Innovations& in);

}  // namespace roadbook
