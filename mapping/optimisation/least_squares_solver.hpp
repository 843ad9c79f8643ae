#pragma once

namespace roadbook {

/// The program that minimises a sum of squares. Both minimise the same residuals with the same
/// robust loss and the same gauge, and give the same bytes on any number of threads.
enum class LeastSquaresSolver {
  kOwn,   ///< Levenberg-Marquardt of this library; faster, uses all threads
  kCeres  ///< Ceres Solver on one thread, to check the other
};

}  // namespace roadbook
