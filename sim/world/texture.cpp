#include "sim/world/texture.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"

namespace roadbook {
namespace {

/// Appends `image` with the extra column and row to the pyramid.
void append(const cv::Mat& image, TexturePyramid& pyramid) {
  const auto level = static_cast<std::size_t>(++pyramid.last);
  ROADBOOK_ASSERT(level < TexturePyramid::kMostLevels);
  const auto w = static_cast<std::size_t>(image.cols);
  const auto h = static_cast<std::size_t>(image.rows);
  const std::size_t begin = pyramid.texels.size();
  const std::size_t end = begin + (w + 1) * (h + 1);
  ROADBOOK_ASSERT(end < static_cast<std::size_t>(std::numeric_limits<int>::max()));
  pyramid.texels.resize(end);
  for (std::size_t y = 0; y <= h; ++y) {
    const std::size_t from = y < h ? y : (pyramid.tiled ? 0 : h - 1);
    const auto* source = image.ptr<std::uint8_t>(static_cast<int>(from));
    std::uint8_t* row = pyramid.texels.data() + begin + y * (w + 1);
    std::memcpy(row, source, w);
    row[w] = source[pyramid.tiled ? 0 : w - 1];
  }
  pyramid.offset[level] = static_cast<int>(begin);
  pyramid.stride[level] = static_cast<int>(w + 1);
  pyramid.width[level] = image.cols;
  pyramid.height[level] = image.rows;
}

}  // namespace

Texture::Texture(const cv::Mat& image, bool tiled) {
  ROADBOOK_ASSERT(image.type() == CV_8UC1 && !image.empty());
  const auto power_of_two = [](int n) { return std::has_single_bit(static_cast<unsigned>(n)); };
  ROADBOOK_ASSERT(!tiled || (power_of_two(image.cols) && power_of_two(image.rows)));
  pyramid_.tiled = tiled;
  pyramid_.texels.reserve(image.total() * 4 / 3 + 2 * static_cast<std::size_t>(image.cols) +
                          2 * static_cast<std::size_t>(image.rows) + 64);
  cv::Mat level = image;
  while (true) {
    append(level, pyramid_);
    if (level.cols <= 1 || level.rows <= 1) break;
    // Odd sizes: the last row or column counts half; the difference is not visible.
    cv::Mat half;
    cv::resize(level, half, {level.cols / 2, level.rows / 2}, 0, 0, cv::INTER_AREA);
    level = half;
  }
  pyramid_.texels.resize(pyramid_.texels.size() + 4);  // four bytes are read at once
}

void Texture::look_up(Lookups& lookups) const {
  static const auto best = choose_texture_lookup();
  best(pyramid_, lookups);
}

float Texture::sample(float x, float y, float footprint) const {
  return texture_at(pyramid_, x, y, footprint);
}

}  // namespace roadbook
