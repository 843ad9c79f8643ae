#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "drive/images/image_header.hpp"

namespace roadbook {

// 8-bit grey PNG images by libdeflate. Four cameras of 1280x960 at 12.5 Hz have to be decoded at
// the same time as all other work. bench/images_bench.cpp compares this decoder with cv::imread
// (less than half of its time; figures in docs/results/speed.md).

/// The image, or nothing where the file is damaged (checksums are verified) or not an 8-bit grey
/// PNG without interlacing. `header` is what `inspect_image` said of `content`. Safe to call
/// concurrently.
[[nodiscard]] std::optional<cv::Mat> decode_grey_png(std::span<const std::uint8_t> content,
                                                     const ImageHeader& header);

/// Whether the chunks of a PNG file are whole, with the checksums they state, to its end.
[[nodiscard]] bool png_chunks_whole(std::span<const std::uint8_t> content);

/// A PNG file of an 8-bit single-channel image; the same bytes every time.
[[nodiscard]] std::vector<std::uint8_t> encode_grey_png(const cv::Mat& grey);

/// Means of 2x2 pixels, rounded to nearest (half up); an odd last row or column is dropped.
[[nodiscard]] cv::Mat half_size(const cv::Mat& grey);

}  // namespace roadbook
