#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

namespace roadbook {

// 16-bit images hold the greys of a camera with 10, 12 or 14 bits, often unscaled: their upper 8
// bits are then nearly black. One range for all images of a camera brings them to 8 bits, so that
// the same grey has the same value in all of them.

/// The 16-bit greys that become 0 to 255: value = (grey - black) * 256 / span, rounded down.
struct GreyRange {
  int black = 0;
  int span = 65536;  ///< number of greys, at least 256
};

/// A range for images whose greys go from `least` to `most`: as many bits as `most` has. If the
/// greys fill less than a quarter of these, as those of thermal cameras do, the range is twice as
/// wide as they are. The upper 8 bits if all greys are 0.
[[nodiscard]] GreyRange grey_range(int least, int most);

/// The range of a camera, from twelve of its `images`, evenly spaced. Empty if none can be read.
/// Deterministic on any number of threads.
[[nodiscard]] std::optional<GreyRange> measured_grey_range(
    const std::vector<std::filesystem::path>& images, int num_threads);

/// The 16-bit image `deep` (CV_16UC1) with 8 bits. Greys outside `range` become black or white.
[[nodiscard]] cv::Mat to_8_bits(const cv::Mat& deep, const GreyRange& range);

}  // namespace roadbook
