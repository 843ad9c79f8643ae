#pragma once

#include <Eigen/Core>
#include <opencv2/objdetect.hpp>

#include "semantics/detector/hog_window.hpp"
#include "semantics/people/person_camera.hpp"

namespace roadbook {

/// HOG features of a person window: 6 x 12 cells of 8 pixels, a person 72 of 96 pixels high. As in
/// Dalal and Triggs 2005 at three quarters of their size (96 of 128 pixels).
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

  /// Patch of a box with one extra pixel on each side, so that gradients at the border come from
  /// the image.
  [[nodiscard]] static CylinderPatch patch(const PersonBox& box);
  /// `crop`: a window, with or without the border of one pixel; 8 bit.
  [[nodiscard]] Eigen::VectorXd feature(const cv::Mat& crop) const;
  [[nodiscard]] Eigen::VectorXd feature(const PersonCamera& camera,
                                        const ImagePyramid& image,
                                        const PersonBox& box) const;
  /// HOG blocks of a whole image (HogWindow::blocks_of).
  [[nodiscard]] Eigen::MatrixXf blocks_of(const cv::Mat& grey, cv::Size& grid) const;

 private:
  cv::HOGDescriptor window_;
  cv::HOGDescriptor block_;
};

}  // namespace roadbook
