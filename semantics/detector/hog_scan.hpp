#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>

namespace roadbook {

/// Score of each window, indexed by row and column of its first block in the grid.
using WindowScores = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Scores of a linear classifier for every window on a grid of HOG blocks. `weights`: 36 x (blocks
/// of a window), one column per block, block rows first (see `block_weights`); `blocks`: 36 x
/// (blocks of the grid), row by row. Empty if the window is larger than the grid.
[[nodiscard]] WindowScores scan_windows(const Eigen::MatrixXf& weights,
                                        double bias,
                                        cv::Size window,
                                        const Eigen::MatrixXf& blocks,
                                        cv::Size grid);

/// Converts the weights of a feature vector to the form of `scan_windows`.
[[nodiscard]] Eigen::MatrixXf block_weights(const Eigen::VectorXd& weights);

}  // namespace roadbook
