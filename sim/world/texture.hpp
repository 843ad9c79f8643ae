#pragma once

#include <opencv2/core/mat.hpp>

#include "sim/world/texture_lookup.hpp"

namespace roadbook {

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
  /// texel: 0, 0), averaged over about `footprint` texels. Two levels are blended only near half
  /// way between them. So most lookups read one level, and the change of level shows no line.
  void look_up(Lookups& lookups) const;
  /// The same bits for one position. `look_up` is several times faster.
  [[nodiscard]] float sample(float x, float y, float footprint) const;

 private:
  TexturePyramid pyramid_;
};

}  // namespace roadbook
