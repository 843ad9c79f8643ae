#include "drive/images/grey_range.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kSampledImages = 12;
constexpr int kNarrowShare = 4;  // greys that fill less than 1 / kNarrowShare of their bits

struct Extremes {
  int least = std::numeric_limits<int>::max();
  int most = -1;
};

Extremes extremes_of(const std::filesystem::path& file) {
  Extremes found;
  try {
    const cv::Mat deep = cv::imread(
        file.string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
    if (deep.type() != CV_16UC1) return found;
    double least = 0.0;
    double most = 0.0;
    cv::minMaxLoc(deep, &least, &most);
    return {static_cast<int>(least), static_cast<int>(most)};
  } catch (const cv::Exception&) {
    return found;
  }
}

}  // namespace

GreyRange grey_range(int least, int most) {
  if (most <= 0) return {};
  const int bits = std::max<int>(8, std::bit_width(static_cast<unsigned>(most)));
  const int span = 1 << bits;
  const int filled = most - least + 1;
  if (kNarrowShare * filled >= span) return {0, span};
  return {std::max(0, least - filled / 2), std::max(256, 2 * filled)};
}

std::optional<GreyRange> measured_grey_range(const std::vector<std::filesystem::path>& images,
                                             int num_threads) {
  const std::size_t count = std::min(kSampledImages, images.size());
  std::vector<Extremes> sampled(count);
  parallel_for(count, num_threads, [&](std::size_t i) {
    sampled[i] = extremes_of(images[count < 2 ? 0 : i * (images.size() - 1) / (count - 1)]);
  });
  Extremes all;
  for (const Extremes& one : sampled) {
    if (one.most < 0) continue;
    all.least = std::min(all.least, one.least);
    all.most = std::max(all.most, one.most);
  }
  if (all.most < 0) return std::nullopt;
  return grey_range(all.least, all.most);
}

cv::Mat to_8_bits(const cv::Mat& deep, const GreyRange& range) {
  ROADBOOK_ASSERT(deep.type() == CV_16UC1 && range.span >= 256);
  cv::Mat image(deep.rows, deep.cols, CV_8UC1);
  for (int y = 0; y < deep.rows; ++y) {
    const std::uint16_t* const in = deep.ptr<std::uint16_t>(y);
    std::uint8_t* const out = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < deep.cols; ++x)
      out[x] =
          static_cast<std::uint8_t>(std::clamp((in[x] - range.black) * 256 / range.span, 0, 255));
  }
  return image;
}

}  // namespace roadbook
