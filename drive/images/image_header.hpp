#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace roadbook {

// The properties that an image file states, found without decoding. Decoding is no safe check: a 1
// MB PNG can claim 32000x32000 pixels, and OpenCV decodes a truncated JPEG without any message.

enum class ImageFormat { kNone, kPng, kJpeg };

enum class ImageState {
  kGood,
  kMissing,    ///< no such file, or not to be read
  kUnknown,    ///< neither PNG nor JPEG
  kDamaged,    ///< the header contradicts itself
  kTruncated,  ///< the end marker is missing
};

struct ImageHeader {
  ImageState state = ImageState::kMissing;
  ImageFormat format = ImageFormat::kNone;
  std::int64_t width = 0;  ///< [px]
  std::int64_t height = 0;
  int channels = 0;
  int bits = 0;  ///< a sample
  bool interlaced = false;
  std::uint64_t bytes = 0;  ///< size of the file
  std::uint64_t tail = 0;   ///< hash of its last 64 bytes; of unlike images nearly always unlike
};

/// Reads some hundred bytes at the file's head and tail (for a JPEG as many as stand before its
/// frame header). Never throws; safe to call concurrently.
[[nodiscard]] ImageHeader inspect_image(const std::filesystem::path& file);
[[nodiscard]] ImageHeader inspect_image(std::span<const std::uint8_t> content);

/// "missing", "neither PNG nor JPEG", ... for messages.
[[nodiscard]] std::string to_text(ImageState state);

}  // namespace roadbook
