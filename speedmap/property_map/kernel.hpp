#pragma once

#include <cstddef>

namespace roadbook {

// The sparse kernel of Melkumyan and Ramos [SPM, eq. 7], with the corrected support: positive for
// d < D, zero from D on. Its amplitude cancels in the normalised interpolation [SPM, eq. 6] and is
// left out: k(0) = 1.
//
// With theta = 2 pi (1 - r), r = d / D, k = [theta (2 + cos theta) - 3 sin theta] / (6 pi): four
// times continuously differentiable in the plane; the fifth derivative jumps at r = 1 and at r = 0.

/// k(r), r = d / D >= 0. Non-negative; relative accuracy kept up to the edge of the support.
[[nodiscard]] double sparse_kernel(double r);

/// Factors of the gradient and Hessian of k(|x|) in the plane, finite at r = 0:
///   grad k = first_over_r x,   Hessian k = first_over_r 1 + bend x x^T.
struct KernelDerivatives {
  double value = 0.0;
  double first_over_r = 0.0;  ///< k'(r) / r
  double bend = 0.0;          ///< (k''(r) - k'(r) / r) / r^2
};
[[nodiscard]] KernelDerivatives sparse_kernel_derivatives(double r);

/// Computes k(sqrt(r2)) of `count` numbers, each r2 < 1: the inner loop of every update. The same
/// bytes on every machine.
void sparse_kernel_of_squares(const double* r2, double* k, std::size_t count);

}  // namespace roadbook
