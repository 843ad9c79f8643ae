#pragma once

#include <Eigen/Core>
#include <opencv2/objdetect.hpp>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

// HOG features (Dalal and Triggs 2005, OpenCV's implementation) of a box with a margin: blocks of 2
// x 2 cells of 8 pixels, one block per cell step.

struct HogWindowOptions {
  int cells_long = 8;   ///< cells of 8 pixels along the box; the width follows from its shape
  double margin = 1.3;  ///< window size over box size, so that the box's border is inside

  /// Throws InvalidOption.
  void check() const;
};

/// Descriptor for windows of `window` pixels, with the cells and blocks of HogWindow.
[[nodiscard]] cv::HOGDescriptor hog_descriptor(cv::Size window);

class HogWindow {
 public:
  /// `length_m` and `width_m` of a typical box.
  HogWindow(double length_m, double width_m, const HogWindowOptions& options = {});

  static constexpr int kCell = 8;        ///< [px]
  static constexpr int kBlockSize = 36;  ///< values per block: 4 cells of 9 orientations
  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] double width_m() const { return width_m_; }
  [[nodiscard]] double pixel_m() const { return pixel_m_; }  ///< pixel size for a typical box
  [[nodiscard]] cv::Size blocks() const { return blocks_; }  ///< along, across
  [[nodiscard]] Eigen::Index feature_size() const {
    return Eigen::Index{kBlockSize} * blocks_.area();
  }

  /// Feature vector of a box of any size, scaled by its length. Blocks are concatenated with the
  /// index across the box running fastest.
  [[nodiscard]] Eigen::VectorXd feature(const GroundImage& image, const OrientedBox& box) const;

  /// Blocks of a whole image, one per cell: block (row, column) of the grid is column row * columns
  /// + column of the matrix (36 x blocks). The last row and column of cells start no block.
  [[nodiscard]] Eigen::MatrixXf blocks_of(const cv::Mat& grey, cv::Size& grid) const;

  /// Weights that give a box approximately the score that `weights` give the box turned by pi.
  /// (OpenCV's blocks are not exactly symmetric.)
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
