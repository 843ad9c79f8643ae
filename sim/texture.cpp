#include "sim/texture.hpp"

#include <bit>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"

namespace roadbook {

Texture::Texture(cv::Mat image, bool tiled) : tiled_(tiled) {
  ROADBOOK_ASSERT(image.type() == CV_8UC1 && !image.empty());
  const auto power_of_two = [](int n) { return std::has_single_bit(static_cast<unsigned>(n)); };
  ROADBOOK_ASSERT(!tiled || (power_of_two(image.cols) && power_of_two(image.rows)));
  float scale = 1.0F;
  while (true) {
    levels_.push_back({image.data, image.cols, image.rows, static_cast<int>(image.step), scale});
    images_.push_back(image);
    if (image.cols <= 1 || image.rows <= 1) break;
    // Odd sizes: the last row or column counts half, which nobody sees.
    cv::Mat half;
    cv::resize(image, half, {image.cols / 2, image.rows / 2}, 0, 0, cv::INTER_AREA);
    image = half;
    scale *= 0.5F;
  }
}

}  // namespace roadbook
