#pragma once

#include <Eigen/Core>
#include <opencv2/objdetect.hpp>

#include "semantics/detector/hog_window.hpp"
#include "semantics/people/person_camera.hpp"

namespace roadbook {

/// Histograms of oriented gradients of an upright window: 6 x 12 cells of 8 pixels, a person 72 of
/// its 96 pixels high, as in Dalal and Triggs 2005 (128 and 96) at three quarters of the size.
class PersonWindow {
 public:
  PersonWindow();

  static constexpr int kCell = HogWindow::kCell;  ///< [px]
  static constexpr int kWidth = 48;               ///< [px]
  static constexpr int kHeight = 96;              ///< [px]
  static constexpr int kPerson = 72;              ///< height of a person in the window [px]
  static constexpr int kMargin = 12;              ///< above the head and below the feet [px]
  static constexpr int kBlockSize = 36;
  [[nodiscard]] static cv::Size blocks() { return {kWidth / kCell - 1, kHeight / kCell - 1}; }
  [[nodiscard]] static Eigen::Index feature_size() {
    return Eigen::Index{kBlockSize} * blocks().area();
  }

  /// The window of a box with one pixel more on each side, so that gradients at its border are
  /// those of the scene.
  [[nodiscard]] static CylinderPatch patch(const PersonBox& box);
  /// `crop`: a window, or one with a border of one pixel; 8 bit.
  [[nodiscard]] Eigen::VectorXd feature(const cv::Mat& crop) const;
  [[nodiscard]] Eigen::VectorXd feature(const PersonCamera& camera,
                                        const ImagePyramid& image,
                                        const PersonBox& box) const;
  /// Blocks of a whole picture (HogWindow::blocks_of).
  [[nodiscard]] Eigen::MatrixXf blocks_of(const cv::Mat& grey, cv::Size& grid) const;

 private:
  cv::HOGDescriptor window_;
  cv::HOGDescriptor block_;
};

}  // namespace roadbook
