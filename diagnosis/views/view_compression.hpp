#pragma once

#include <Eigen/Core>

#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {

/// Duration of the stretches whose rows are compressed into one factor [s].
inline constexpr double kCompressedSeconds = 0.8;

/// Compresses the projected rows of each stretch of driving into an upper triangular factor R with
/// R^T R = G, the products of all sides. `sums`: one row an elementary column, one column a
/// candidate, weights 0 or 1. Sides of the result: the residual, then one a column of `sums`.
/// Scores and information are unchanged by the compression.
[[nodiscard]] Innovations compressed_innovations(const ViewSystem& system,
                                                 const ViewData& data,
                                                 const Eigen::MatrixXd& sums);

/// One row of each landmark (x and y in turn) and all ground rows. Their correlation through the
/// projection is small, so tests of whiteness and normality apply to them.
[[nodiscard]] Innovations landmark_innovations(const ViewSystem& system,
                                               const ViewData& data,
                                               const Eigen::MatrixXd& sums);

}  // namespace roadbook
