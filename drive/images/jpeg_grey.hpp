#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>

#include "drive/images/image_header.hpp"

namespace roadbook {

/// The brightness of a grey or colour JPEG, as cv::imdecode gives it, or nothing where libjpeg
/// finds the pixels damaged: OpenCV hides that warning and fills up with grey. JPEG has no
/// checksum, so damage that reads as other valid codes stays unseen. `header` is what
/// `inspect_image` said of `content`; its size is checked again. Safe to call concurrently.
[[nodiscard]] std::optional<cv::Mat> decode_grey_jpeg(std::span<const std::uint8_t> content,
                                                      const ImageHeader& header);

}  // namespace roadbook
