#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "speedmap/property_map/knots.hpp"

namespace roadbook {

// Normalised interpolation I_v^l [SPM, eq. 6]: the share of each knot in the value at a position.

/// The knots near one position and their shares. Reuse one object for many positions: it keeps its
/// memory.
struct Interpolation {
  std::vector<std::int32_t> knots;
  std::vector<double> weights;  ///< I_v^l > 0; their sum is 1
  double kernel_sum = 0.0;      ///< of the kernels, before normalising

  [[nodiscard]] bool covered() const { return !knots.empty(); }
  [[nodiscard]] std::size_t size() const { return knots.size(); }
};

/// First and second derivatives of the shares in (s, e), in the order of `Interpolation::knots`.
struct InterpolationDerivatives {
  std::vector<Eigen::Vector2d> gradients;
  std::vector<Eigen::Matrix2d> hessians;
};

/// Computes the shares at `v`. The result is not covered (has no knots) if no knot is within its
/// kernel width of `v`, where equation 6 is 0/0.
void interpolate(const Knots& knots, const PathPlace& v, Interpolation& result);

/// The same with first and second derivatives: grad I = (grad K - I sum grad K) / S.
void interpolate(const Knots& knots,
                 const PathPlace& v,
                 Interpolation& result,
                 InterpolationDerivatives& derivatives);

}  // namespace roadbook
