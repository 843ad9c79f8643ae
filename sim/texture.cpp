#include "sim/texture.hpp"

#include <bit>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "base/error.hpp"

namespace roadbook {

Texture::Texture(cv::Mat image, bool tiled) : tiled_(tiled) {
  ROADBOOK_ASSERT(image.type() == CV_8UC1 && !image.empty());
  const auto power_of_two = [](int n) { return std::has_single_bit(static_cast<unsigned>(n)); };
  ROADBOOK_ASSERT(!tiled || (power_of_two(image.cols) && power_of_two(image.rows)));
  while (true) {
    Level level;
    level.image = std::move(image);
    level.data = level.image.data;
    level.width = level.image.cols;
    level.height = level.image.rows;
    level.stride = static_cast<int>(level.image.step);
    levels_.push_back(level);
    if (level.width <= 1 || level.height <= 1) break;
    // Odd sizes: the last row or column counts half, which nobody sees.
    cv::resize(level.image, image, {level.width / 2, level.height / 2}, 0, 0, cv::INTER_AREA);
  }
}

}  // namespace roadbook
