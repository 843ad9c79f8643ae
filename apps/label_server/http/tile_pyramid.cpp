#include "apps/label_server/http/tile_pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace roadbook {
namespace {

constexpr std::size_t kCacheBytes = 64 * 1024 * 1024;

// Halves the resolution: each pixel is the mean of the seen pixels among two by two.
cv::Mat halved(const cv::Mat& grey) {
  cv::Mat half(std::max(1, (grey.rows + 1) / 2), std::max(1, (grey.cols + 1) / 2), CV_8U);
  for (int row = 0; row < half.rows; ++row) {
    const auto* const a = grey.ptr<std::uint8_t>(2 * row);
    const auto* const b = grey.ptr<std::uint8_t>(std::min(2 * row + 1, grey.rows - 1));
    auto* const out = half.ptr<std::uint8_t>(row);
    for (int column = 0; column < half.cols; ++column) {
      const int left = 2 * column;
      const int right = std::min(left + 1, grey.cols - 1);
      const int values[] = {a[left], a[right], b[left], b[right]};
      int sum = 0;
      int count = 0;
      for (const int value : values) {
        sum += value;
        count += value > 0 ? 1 : 0;
      }
      out[column] = count == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(sum / count);
    }
  }
  return half;
}

}  // namespace

TilePyramid::TilePyramid(const GroundImage& image) : finest_m_(image.resolution_m) {
  if (image.grey.empty()) return;
  cv::Mat grey;
  cv::max(image.grey, 1, grey);
  grey.setTo(0, image.seen == 0);
  pictures_.push_back(grey);
  while (std::max(pictures_.back().rows, pictures_.back().cols) > kTilePx)
    pictures_.push_back(halved(pictures_.back()));
}

double TilePyramid::resolution_m(int level) const {
  return std::ldexp(finest_m_, levels() - 1 - level);
}

std::string TilePyramid::encoded(const Key& key) const {
  const auto [level, column, row] = key;
  const cv::Mat& picture = pictures_[static_cast<std::size_t>(levels() - 1 - level)];
  const cv::Rect place = cv::Rect(column * kTilePx, row * kTilePx, kTilePx, kTilePx) &
                         cv::Rect(0, 0, picture.cols, picture.rows);
  cv::Mat grey(kTilePx, kTilePx, CV_8U, cv::Scalar(0));
  picture(place).copyTo(grey(cv::Rect(0, 0, place.width, place.height)));
  cv::Mat pixels;
  cv::merge(std::vector<cv::Mat>{grey, grey, grey, cv::Mat(grey > 0)}, pixels);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", pixels, bytes, {cv::IMWRITE_PNG_COMPRESSION, 3});
  return {bytes.begin(), bytes.end()};
}

std::shared_ptr<const std::string> TilePyramid::tile(int level, int column, int row) const {
  if (level < 0 || level >= levels() || column < 0 || row < 0) return nullptr;
  const cv::Mat& picture = pictures_[static_cast<std::size_t>(levels() - 1 - level)];
  if (column > (picture.cols - 1) / kTilePx || row > (picture.rows - 1) / kTilePx) return nullptr;
  const Key key{level, column, row};
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = kept_.find(key); found != kept_.end()) return found->second;
  }
  const auto made = std::make_shared<const std::string>(encoded(key));
  const std::lock_guard lock(mutex_);
  if (!kept_.emplace(key, made).second) return made;
  order_.push_back(key);
  kept_bytes_ += made->size();
  while (kept_bytes_ > kCacheBytes && order_.size() > 1) {
    const auto oldest = kept_.find(order_.front());
    kept_bytes_ -= oldest->second->size();
    kept_.erase(oldest);
    order_.pop_front();
  }
  return made;
}

}  // namespace roadbook
