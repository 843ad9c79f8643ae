#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace roadbook {

/// Places to look up in one texture, and the values found. Component by component, because eight
/// are read at once.
struct Lookups {
  static constexpr std::size_t kMost = 384;

  std::size_t count = 0;
  alignas(32) std::array<float, kMost> x, y, footprint, value;
  std::array<std::uint16_t, kMost> owner;  ///< for the caller: whom the value is for

  void add(float at_x, float at_y, float wide, std::size_t whose) {
    x[count] = at_x;
    y[count] = at_y;
    footprint[count] = wide;
    owner[count++] = static_cast<std::uint16_t>(whose);
  }
};

/// All halved versions of a texture in one piece of memory. Every level has one column and one row
/// more than it shows (the first ones again, or the last ones), so that the right and the lower
/// neighbour of a texel are always there.
struct TexturePyramid {
  static constexpr std::size_t kMostLevels = 16;

  std::vector<std::uint8_t> texels;
  std::array<int, kMostLevels> offset{}, stride{}, width{}, height{};
  int last = -1;  ///< coarsest level
  bool tiled = false;
};

/// A grey texture. Values are brightness as displayed (gamma applied).
class Texture {
 public:
  Texture() = default;
  /// `image` has 8 bit and one channel. A tiled texture repeats and has powers of two as its sides;
  /// others continue their border values.
  Texture(const cv::Mat& image, bool tiled);

  [[nodiscard]] int width() const { return pyramid_.width[0]; }
  [[nodiscard]] int height() const { return pyramid_.height[0]; }

  /// Fills the values of the lookups: at (x, y) in texels of the finest level (centre of the first
  /// texel: 0, 0), averaged over about `footprint` texels. Two levels are mixed only about half way
  /// between them: most places cost one reading, and still no line shows where the level changes.
  void look_up(Lookups& lookups) const;
  /// The same for one place, bit by bit; eight at once are several times faster.
  [[nodiscard]] float sample(float x, float y, float footprint) const;

 private:
  TexturePyramid pyramid_;
};

}  // namespace roadbook
