#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace roadbook {

/// A grey texture with all its halved versions. Values are brightness as displayed (gamma applied).
class Texture {
 public:
  Texture() = default;
  /// Takes over `image` (8 bit, one channel). A tiled texture repeats; others end at their border.
  Texture(cv::Mat image, bool tiled);

  [[nodiscard]] int width() const { return levels_.empty() ? 0 : levels_[0].width; }
  [[nodiscard]] int height() const { return levels_.empty() ? 0 : levels_[0].height; }

  /// Value at (x, y) in texels of the finest level (centre of the first texel: 0, 0), averaged over
  /// about `footprint` texels: trilinear.
  [[nodiscard]] float sample(float x, float y, float footprint) const {
    const float lod = footprint <= 1.0F ? 0.0F : fast_log2(footprint);
    const int last = static_cast<int>(levels_.size()) - 1;
    const int level = static_cast<int>(lod);
    if (level >= last) return bilinear(levels_[static_cast<std::size_t>(last)], x, y, last);
    const float f = lod - static_cast<float>(level);
    const float a = bilinear(levels_[static_cast<std::size_t>(level)], x, y, level);
    if (f < 0.02F) return a;
    const float b = bilinear(levels_[static_cast<std::size_t>(level) + 1], x, y, level + 1);
    return a + f * (b - a);
  }

  /// log2 to 0.01, enough to choose a level.
  static float fast_log2(float v) {
    const auto bits = std::bit_cast<std::uint32_t>(v);
    const float m = std::bit_cast<float>((bits & 0x007fffffU) | 0x3f800000U);
    return static_cast<float>(static_cast<int>(bits >> 23U) - 127) + (-0.33582878F * m + 2.0F) * m -
           1.65871022F;
  }

 private:
  struct Level {
    cv::Mat image;
    const std::uint8_t* data = nullptr;
    int width = 0;
    int height = 0;
    int stride = 0;
  };

  static float whole_below(float x) {
    const auto i = static_cast<float>(static_cast<int>(x));
    return i > x ? i - 1.0F : i;
  }

  [[nodiscard]] float bilinear(const Level& l, float x, float y, int level) const {
    const float scale = 1.0F / static_cast<float>(1U << static_cast<unsigned>(level));
    // Texel centres of level k lie at (2^k - 1) / 2 + i 2^k.
    const float u = (x + 0.5F) * scale - 0.5F;
    const float v = (y + 0.5F) * scale - 0.5F;
    // The library's floor is a call on baseline x86-64, and this runs for every pixel.
    const float fu = whole_below(u);
    const float fv = whole_below(v);
    const float a = u - fu;
    const float b = v - fv;
    const int x0 = place(static_cast<int>(fu), l.width);
    const int x1 = place(static_cast<int>(fu) + 1, l.width);
    const std::uint8_t* r0 =
        l.data + static_cast<std::ptrdiff_t>(l.stride) * place(static_cast<int>(fv), l.height);
    const std::uint8_t* r1 =
        l.data + static_cast<std::ptrdiff_t>(l.stride) * place(static_cast<int>(fv) + 1, l.height);
    const float top = static_cast<float>(r0[x0]) + a * static_cast<float>(r0[x1] - r0[x0]);
    const float low = static_cast<float>(r1[x0]) + a * static_cast<float>(r1[x1] - r1[x0]);
    return top + b * (low - top);
  }
  [[nodiscard]] int place(int i, int n) const {
    if (tiled_) return i & (n - 1);
    return i < 0 ? 0 : (i >= n ? n - 1 : i);
  }

  std::vector<Level> levels_;
  bool tiled_ = false;
};

}  // namespace roadbook
