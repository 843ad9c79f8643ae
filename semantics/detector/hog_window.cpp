#include "semantics/detector/hog_window.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr int kGradientBins = 9;

int cells_across(double length_m, double width_m, const HogWindowOptions& options) {
  options.check();
  if (!(length_m > 0.0)) throw InvalidOption("length_m", std::to_string(length_m), "> 0");
  if (!(width_m > 0.0)) throw InvalidOption("width_m", std::to_string(width_m), "> 0");
  const double cells = options.cells_long * width_m / length_m;
  return std::clamp(static_cast<int>(std::lround(cells)), 2, 4 * options.cells_long);
}

}  // namespace

cv::HOGDescriptor hog_descriptor(cv::Size window) {
  const int cell = HogWindow::kCell;
  return {window, {2 * cell, 2 * cell}, {cell, cell}, {cell, cell}, kGradientBins};
}

void HogWindowOptions::check() const {
  if (cells_long < 2 || cells_long > 64)
    throw InvalidOption("cells_long", std::to_string(cells_long), "2 to 64");
  if (!(margin >= 1.0 && margin <= 4.0))
    throw InvalidOption("margin", std::to_string(margin), "1 to 4");
}

HogWindow::HogWindow(double length_m, double width_m, const HogWindowOptions& options)
    : length_m_(length_m),
      width_m_(width_m),
      pixel_m_(length_m * options.margin / (options.cells_long * kCell)),
      blocks_(options.cells_long - 1, cells_across(length_m, width_m, options) - 1),
      window_(hog_descriptor({(blocks_.width + 1) * kCell, (blocks_.height + 1) * kCell})),
      block_(hog_descriptor({2 * kCell, 2 * kCell})) {}

Eigen::VectorXd HogWindow::feature(const GroundImage& image, const OrientedBox& box) const {
  // One pixel more on each side, so that the gradients at the window's border are those of the
  // ground.
  const cv::Size size(window_.winSize.width + 2, window_.winSize.height + 2);
  const cv::Mat patch =
      upright_patch(image, box.centre, box.heading, pixel_m_ * box.length_m / length_m_, size);
  std::vector<float> values;
  window_.compute(patch, values, {kCell, kCell}, {}, {cv::Point(1, 1)});
  return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()))
      .cast<double>();
}

Eigen::MatrixXf HogWindow::blocks_of(const cv::Mat& grey, cv::Size& grid) const {
  grid = {std::max(0, grey.cols / kCell - 1), std::max(0, grey.rows / kCell - 1)};
  std::vector<float> values;
  if (grid.area() > 0) block_.compute(grey, values, {kCell, kCell});
  ROADBOOK_ASSERT(values.size() == static_cast<std::size_t>(grid.area()) * kBlockSize);
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), kBlockSize, grid.area());
}

Eigen::VectorXd HogWindow::turned(const Eigen::VectorXd& weights) const {
  // Half a turn reverses the order of blocks and cells. Directions without sign do not change.
  Eigen::VectorXd out(weights.size());
  const Eigen::Index cells = weights.size() / kGradientBins;
  for (Eigen::Index c = 0; c < cells; ++c)
    out.segment<kGradientBins>(kGradientBins * c) =
        weights.segment<kGradientBins>(kGradientBins * (cells - 1 - c));
  return out;
}

}  // namespace roadbook
