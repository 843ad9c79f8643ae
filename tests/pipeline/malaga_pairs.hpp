#pragma once

#include <array>
#include <cstddef>

namespace roadbook::test {

/// Returns the frame of malaga07_a at the place of a frame of malaga07_b, both as numbers of the
/// recording. Interpolates linearly between the pairs that the README of the data states.
inline double frame_of_malaga_a(double frame_of_b) {
  constexpr std::array<std::array<double, 2>, 5> kPairs{
      {{1600, 0}, {1640, 36}, {1680, 76}, {1720, 124}, {1760, 172}}};
  for (std::size_t i = 1; i < kPairs.size(); ++i)
    if (frame_of_b <= kPairs[i][0])
      return kPairs[i - 1][1] + (frame_of_b - kPairs[i - 1][0]) /
                                    (kPairs[i][0] - kPairs[i - 1][0]) *
                                    (kPairs[i][1] - kPairs[i - 1][1]);
  return kPairs.back()[1];
}

}  // namespace roadbook::test
