#pragma once

namespace roadbook {

/// Solver of a bundle adjustment (`BundleOptions`). Both solvers minimise the same residuals with
/// the same robust loss and the same fixed poses; their results agree up to the convergence
/// tolerance. The result of each solver does not depend on the number of threads.
enum class LeastSquaresSolver {
  kOwn,   ///< Levenberg-Marquardt of this library: faster, uses all threads (default)
  kCeres  ///< Ceres Solver on one thread, as an independent check
};

}  // namespace roadbook
