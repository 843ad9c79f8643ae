#include "sim/render/image_sensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "sensors/brightness.hpp"

namespace roadbook {
namespace {

/// Normal deviates at 4096 equally likely places: drawn by 12 random bits, five from one word.
const std::array<float, 4096>& normal_table() {
  static const auto table = [] {
    std::array<float, 4096> t{};
    // Inverse of the normal distribution by bisection of erf; computed once.
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double p = (static_cast<double>(i) + 0.5) / 4096.0;
      double low = -5.0;
      double high = 5.0;
      for (int k = 0; k < 50; ++k) {
        const double mid = 0.5 * (low + high);
        (0.5 * std::erfc(-mid / std::sqrt(2.0)) < p ? low : high) = mid;
      }
      t[i] = static_cast<float>(0.5 * (low + high));
    }
    return t;
  }();
  return table;
}

}  // namespace

double noise_sigma(double grey, const ImageSensorOptions& options) {
  return std::hypot(options.read_noise, options.shot_noise * std::sqrt(std::max(0.0, grey)));
}

cv::Mat develop(const cv::Mat& brightness,
                const ImageSensorOptions& options,
                std::uint64_t seed,
                std::uint64_t frame,
                std::uint64_t camera,
                int num_threads) {
  cv::Mat grey(brightness.size(), CV_8UC1);
  const auto gain = static_cast<float>(grey_factor(options.gain - 1.0, 0.0, 0.0));
  std::array<float, 256> sigma{};
  for (std::size_t g = 0; g < 256; ++g)
    sigma[g] =
        options.noise ? static_cast<float>(noise_sigma(static_cast<double>(g), options)) : 0.0F;
  const auto& normal = normal_table();
  const double centre_x = 0.5 * (brightness.cols - 1);
  const double centre_y = 0.5 * (brightness.rows - 1);
  parallel_for(static_cast<std::size_t>(brightness.rows), num_threads, [&](std::size_t row) {
    Random random(seed, "image noise", (frame * 16 + camera) * 65536 + row);
    const auto* in = brightness.ptr<float>(static_cast<int>(row));
    auto* out = grey.ptr<std::uint8_t>(static_cast<int>(row));
    std::uint64_t bits = 0;
    int left = 0;
    for (int x = 0; x < brightness.cols; ++x) {
      float value = gain * in[x];
      if (options.vignetting != 0.0) {
        const double r = std::hypot(x - centre_x, static_cast<double>(row) - centre_y) / centre_x;
        value *= static_cast<float>(grey_factor(0.0, options.vignetting, r));
      }
      value = std::clamp(value, 0.0F, 255.0F);
      if (left == 0) {
        bits = random();
        left = 5;
      }
      value += sigma[static_cast<std::size_t>(value)] * normal[bits & 4095U];
      bits >>= 12U;
      --left;
      out[x] = static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
    }
  });
  return grey;
}

}  // namespace roadbook
