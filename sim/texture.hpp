#pragma once

#include <bit>
#include <cstddef>
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
  /// about `footprint` texels. Two levels are mixed only about half way between them: most places
  /// cost one lookup, and still no line shows where the level changes.
  [[nodiscard]] float sample(float x, float y, float footprint) const {
    const float lod = footprint <= 1.0F ? 0.0F : fast_log2(footprint);
    const int last = static_cast<int>(levels_.size()) - 1;
    const int level = static_cast<int>(lod);
    if (level >= last) return bilinear(levels_[static_cast<std::size_t>(last)], x, y);
    const float f = 2.5F * (lod - static_cast<float>(level)) - 0.75F;
    const auto* finer = &levels_[static_cast<std::size_t>(level)];
    if (f <= 0.0F) return bilinear(finer[0], x, y);
    if (f >= 1.0F) return bilinear(finer[1], x, y);
    const float a = bilinear(finer[0], x, y);
    return a + f * (bilinear(finer[1], x, y) - a);
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
    const std::uint8_t* data = nullptr;
    int width = 0;
    int height = 0;
    int stride = 0;
    float scale = 1.0F;  ///< texels of this level per texel of the finest
  };

  /// The library's floor is a call on baseline x86-64, and this runs for every pixel.
  static int whole_below(float x) {
    const int i = static_cast<int>(x);
    return i - (static_cast<float>(i) > x ? 1 : 0);
  }

  [[nodiscard]] float bilinear(const Level& l, float x, float y) const {
    // Texel centres of level k lie at (2^k - 1) / 2 + i 2^k.
    const float u = (x + 0.5F) * l.scale - 0.5F;
    const float v = (y + 0.5F) * l.scale - 0.5F;
    const int iu = whole_below(u);
    const int iv = whole_below(v);
    // Weights of 8 bits: integers until the end cost one conversion instead of four.
    const int a = static_cast<int>((u - static_cast<float>(iu)) * 256.0F);
    const int b = static_cast<int>((v - static_cast<float>(iv)) * 256.0F);
    if (iu >= 0 && iv >= 0 && iu < l.width - 1 && iv < l.height - 1) {
      const std::uint8_t* p = l.data + static_cast<std::ptrdiff_t>(l.stride) * iv + iu;
      const std::uint8_t* q = p + l.stride;
      const int above = (p[0] << 8) + a * (p[1] - p[0]);
      const int under = (q[0] << 8) + a * (q[1] - q[0]);
      return static_cast<float>((above << 8) + b * (under - above)) * (1.0F / 65536.0F);
    }
    const int x0 = place(iu, l.width);
    const int x1 = place(iu + 1, l.width);
    const std::uint8_t* r0 = l.data + static_cast<std::ptrdiff_t>(l.stride) * place(iv, l.height);
    const std::uint8_t* r1 =
        l.data + static_cast<std::ptrdiff_t>(l.stride) * place(iv + 1, l.height);
    const int top = (r0[x0] << 8) + a * (r0[x1] - r0[x0]);
    const int low = (r1[x0] << 8) + a * (r1[x1] - r1[x0]);
    return static_cast<float>((top << 8) + b * (low - top)) * (1.0F / 65536.0F);
  }
  [[nodiscard]] int place(int i, int n) const {
    if (tiled_) return i & (n - 1);
    return i < 0 ? 0 : (i >= n ? n - 1 : i);
  }

  std::vector<cv::Mat> images_;
  std::vector<Level> levels_;
  bool tiled_ = false;
};

}  // namespace roadbook
