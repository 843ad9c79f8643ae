#include "semantics/detector/hog_scan.hpp"

#include "semantics/detector/hog_window.hpp"

namespace roadbook {

WindowScores scan_windows(const Eigen::MatrixXf& weights,
                          double bias,
                          cv::Size window,
                          const Eigen::MatrixXf& blocks,
                          cv::Size grid) {
  const int columns = grid.width - window.width + 1;
  const int rows = grid.height - window.height + 1;
  if (columns < 1 || rows < 1) return {};
  // Blocks of the window x grid, so that the sums below run along rows.
  const WindowScores each = weights.transpose() * blocks;
  WindowScores score = WindowScores::Constant(rows, columns, static_cast<float>(bias));
  for (int a = 0; a < window.width; ++a)
    for (int b = 0; b < window.height; ++b)
      for (int row = 0; row < rows; ++row) {
        const int first = (row + b) * grid.width + a;
        score.row(row) += each.row(a * window.height + b).segment(first, columns);
      }
  return score;
}

Eigen::MatrixXf block_weights(const Eigen::VectorXd& weights) {
  return Eigen::Map<const Eigen::MatrixXd>(weights.data(), HogWindow::kBlockSize,
                                           weights.size() / HogWindow::kBlockSize)
      .cast<float>();
}

}  // namespace roadbook
