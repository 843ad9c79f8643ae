#include "semantics/people/person_window.hpp"

#include <vector>

#include "base/error.hpp"

namespace roadbook {
PersonWindow::PersonWindow()
    : window_(hog_descriptor({kWidth, kHeight})), block_(hog_descriptor({2 * kCell, 2 * kCell})) {}

CylinderPatch PersonWindow::patch(const PersonBox& box) {
  CylinderPatch patch;
  patch.scale = kPerson / box.size;
  patch.size = {kWidth + 2, kHeight + 2};
  // The middle of the window lies between its two middle columns. The feet are at the lower edge of
  // the person's rows.
  patch.left = box.azimuth + 0.5 * (kWidth + 1) / patch.scale;
  patch.top = box.foot_slope + (kMargin + kPerson + 0.5) / patch.scale;
  return patch;
}

Eigen::VectorXd PersonWindow::feature(const cv::Mat& crop) const {
  const int border = (crop.cols - kWidth) / 2;
  ROADBOOK_ASSERT(crop.cols == kWidth + 2 * border && crop.rows == kHeight + 2 * border);
  std::vector<float> values;
  window_.compute(crop, values, {kCell, kCell}, {}, {cv::Point(border, border)});
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()))
      .cast<double>();
}

Eigen::VectorXd PersonWindow::feature(const PersonCamera& camera,
                                      const ImagePyramid& image,
                                      const PersonBox& box) const {
  return feature(camera.cut(image, patch(box)));
}

Eigen::MatrixXf PersonWindow::blocks_of(const cv::Mat& grey, cv::Size& grid) const {
  grid = {std::max(0, grey.cols / kCell - 1), std::max(0, grey.rows / kCell - 1)};
  std::vector<float> values;
  if (grid.area() > 0) block_.compute(grey, values, {kCell, kCell});
  ROADBOOK_ASSERT(values.size() == static_cast<std::size_t>(grid.area()) * kBlockSize);
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), kBlockSize, grid.area());
}

}  // namespace roadbook
