#pragma once

#include <Eigen/Core>
#include <opencv2/objdetect.hpp>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

// Histograms of oriented gradients (Dalal and Triggs 2005, OpenCV's) of a box and its margin:
// blocks of 2 x 2 cells of 8 pixels, one block a cell.

struct HogWindowOptions {
  int cells_long = 8;   ///< of 8 pixels, along the box; its width gets as many as its shape says
  double margin = 1.3;  ///< sides of the window over those of the box: its borders lie inside

  /// Throws InvalidOption.
  void check() const;
};

/// Of windows of that size in pixels, with HogWindow's cells and blocks.
[[nodiscard]] cv::HOGDescriptor hog_descriptor(cv::Size window);

class HogWindow {
 public:
  /// `length_m` and `width_m` of a typical box.
  HogWindow(double length_m, double width_m, const HogWindowOptions& options = {});

  static constexpr int kCell = 8;        ///< [px]
  static constexpr int kBlockSize = 36;  ///< numbers of a block: 4 cells of 9 directions
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double width_m() const { return width_m_; }
  [[nodiscard]] double pixel_m() const { return pixel_m_; }  ///< of the window, for a typical box
  [[nodiscard]] cv::Size blocks() const { return blocks_; }  ///< along, across
  [[nodiscard]] Eigen::Index feature_size() const {
    return Eigen::Index{kBlockSize} * blocks_.area();
  }

  /// Feature of a box of any size: it is scaled by its length. Blocks stand one after another,
  /// across first.
  [[nodiscard]] Eigen::VectorXd feature(const GroundImage& image, const OrientedBox& box) const;

  /// Blocks of a whole picture, one a cell: element (row, column) is block row * columns + column
  /// of the matrix (36 x blocks). Pixels of the border of one cell have no block of their own.
  [[nodiscard]] Eigen::MatrixXf blocks_of(const cv::Mat& grey, cv::Size& grid) const;

  /// Weights that score a box as `weights` score the box turned by half a turn, nearly (OpenCV's
  /// blocks are not quite symmetric).
  [[nodiscard]] Eigen::VectorXd turned(const Eigen::VectorXd& weights) const;

 private:
  double length_m_;
  double width_m_;
  double pixel_m_;
  cv::Size blocks_;
  cv::HOGDescriptor window_;
  cv::HOGDescriptor block_;
};

}  // namespace roadbook
