#pragma once

#include <Eigen/Core>

#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/views/view_system.hpp"

namespace roadbook {

/// Length of driving of which the rows are compressed into one factor [s].
inline constexpr double kCompressedSeconds = 0.8;

/// Of each stretch of driving the products G of all its projected sides, as rows of a triangular R
/// with R^T R = G. Sides: residual, then `sums` (sums of elementary columns, weights 0 or 1).
[[nodiscard]] Innovations compressed_innovations(const ViewSystem& system,
                                                 const ViewData& data,
                                                 const Eigen::MatrixXd& sums);

/// One view of each landmark (x and y in turn) and the ground: rows that have little to do with
/// each other through what was projected out, for checks.
[[nodiscard]] Innovations landmark_innovations(const ViewSystem& system,
                                               const ViewData& data,
                                               const Eigen::MatrixXd& sums);

}  // namespace roadbook
