#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

namespace roadbook {

/// An element a window, its first block's row and column in the grid.
using WindowScores = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Scores of a linear classifier for every window on a grid of HOG blocks: element (row, column) is
/// that of the window whose first block stands there. `weights`: 36 x blocks of a window, one block
/// a column, across (down the rows of the grid) first; `blocks`: 36 x blocks of the grid, row by
/// row. Empty where the window does not fit.
[[nodiscard]] WindowScores scan_windows(const Eigen::MatrixXf& weights,
                                        double bias,
                                        cv::Size window,
                                        const Eigen::MatrixXf& blocks,
                                        cv::Size grid);

/// Weights of a feature vector as `scan_windows` wants them.
[[nodiscard]] Eigen::MatrixXf block_weights(const Eigen::VectorXd& weights);

}  // namespace roadbook
