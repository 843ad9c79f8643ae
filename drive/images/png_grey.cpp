#include "drive/images/png_grey.hpp"

#include <libdeflate.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

#include "base/error.hpp"
#include "base/target_clones.hpp"

namespace roadbook {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

struct FreeDecompressor {
  void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
};
struct FreeCompressor {
  void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
};

std::uint32_t big_endian_word(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

// The compressed pixels: content of all IDAT chunks, checksums verified.
std::optional<Bytes> compressed_pixels(Bytes content, std::vector<std::uint8_t>& joined) {
  Bytes first;
  std::size_t chunks = 0;
  for (std::size_t at = kSignature.size(); content.size() - at >= 12;) {
    const std::size_t length = big_endian_word(&content[at]);
    if (length > content.size() - at - 12) return std::nullopt;
    const Bytes type = content.subspan(at + 4, 4);
    const Bytes data = content.subspan(at + 8, length);
    if (libdeflate_crc32(0, type.data(), 4 + length) != big_endian_word(&content[at + 8 + length]))
      return std::nullopt;
    at += 12 + length;
    if (std::memcmp(type.data(), "IEND", 4) == 0) {
      if (chunks == 0) return std::nullopt;
      return chunks == 1 ? first : Bytes(joined);
    }
    if (std::memcmp(type.data(), "IDAT", 4) != 0) continue;
    if (chunks == 0) {
      first = data;
    } else {
      if (chunks == 1) joined.assign(first.begin(), first.end());
      joined.insert(joined.end(), data.begin(), data.end());
    }
    ++chunks;
  }
  return std::nullopt;
}

ROADBOOK_CLONES __attribute__((optimize("O3"))) void add_rows(const std::uint8_t* __restrict a,
                                                              const std::uint8_t* __restrict b,
                                                              std::uint8_t* __restrict out,
                                                              int n) {
  for (int i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(a[i] + b[i]);
}

int paeth(int left, int up, int corner) {
  const int p = left + up - corner;
  const int to_left = std::abs(p - left);
  const int to_up = std::abs(p - up);
  const int to_corner = std::abs(p - corner);
  if (to_left <= to_up && to_left <= to_corner) return left;
  return to_up <= to_corner ? up : corner;
}

// One row of the PNG filters (specification, section 9); `up` is the row above, zeros at the top.
bool unfilter_row(
    int filter, const std::uint8_t* in, const std::uint8_t* up, std::uint8_t* out, int n) {
  int left = 0;
  int corner = 0;
  switch (filter) {
    case 0:
      std::memcpy(out, in, static_cast<std::size_t>(n));
      return true;
    case 1:
      for (int i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(left = (in[i] + left) & 0xff);
      return true;
    case 2:
      add_rows(in, up, out, n);
      return true;
    case 3:
      for (int i = 0; i < n; ++i)
        out[i] = static_cast<std::uint8_t>(left = (in[i] + (left + up[i]) / 2) & 0xff);
      return true;
    case 4:
      for (int i = 0; i < n; ++i) {
        left = (in[i] + paeth(left, up[i], corner)) & 0xff;
        corner = up[i];
        out[i] = static_cast<std::uint8_t>(left);
      }
      return true;
    default:
      return false;
  }
}

void append_big_endian(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(std::vector<std::uint8_t>& out, std::string_view type, Bytes data) {
  append_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_big_endian(out, libdeflate_crc32(0, &out[begin], out.size() - begin));
}

ROADBOOK_CLONES __attribute__((optimize("O3"))) void half_row(const std::uint8_t* __restrict a,
                                                              const std::uint8_t* __restrict b,
                                                              std::uint8_t* __restrict out,
                                                              int n) {
  for (int i = 0; i < n; ++i) {
    const int sum = a[2 * i] + a[2 * i + 1] + b[2 * i] + b[2 * i + 1];
    out[i] = static_cast<std::uint8_t>((sum + 2) >> 2);
  }
}

}  // namespace

std::optional<cv::Mat> decode_grey_png(std::span<const std::uint8_t> content,
                                       const ImageHeader& header) {
  if (header.state != ImageState::kGood || header.format != ImageFormat::kPng ||
      header.channels != 1 || header.bits != 8 || header.interlaced)
    return std::nullopt;
  thread_local const std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor(
      libdeflate_alloc_decompressor());
  thread_local std::vector<std::uint8_t> joined;
  thread_local std::vector<std::uint8_t> filtered;
  joined.clear();
  const auto pixels = compressed_pixels(content, joined);
  if (!pixels) return std::nullopt;
  const auto width = static_cast<std::size_t>(header.width);
  const auto height = static_cast<std::size_t>(header.height);
  filtered.resize((width + 1) * height);
  // Without a place for the size found, libdeflate demands exactly the size given.
  if (libdeflate_zlib_decompress(decompressor.get(), pixels->data(), pixels->size(),
                                 filtered.data(), filtered.size(), nullptr) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  cv::Mat image(static_cast<int>(height), static_cast<int>(width), CV_8UC1);
  const std::vector<std::uint8_t> zeros(width, 0);
  const std::uint8_t* up = zeros.data();
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* const in = &filtered[y * (width + 1)];
    std::uint8_t* const out = image.ptr<std::uint8_t>(static_cast<int>(y));
    if (!unfilter_row(in[0], in + 1, up, out, static_cast<int>(width))) return std::nullopt;
    up = out;
  }
  return image;
}

bool png_chunks_whole(std::span<const std::uint8_t> content) {
  std::vector<std::uint8_t> joined;
  return content.size() > kSignature.size() && compressed_pixels(content, joined).has_value();
}

std::vector<std::uint8_t> encode_grey_png(const cv::Mat& grey) {
  ROADBOOK_ASSERT(grey.type() == CV_8UC1 && !grey.empty());
  // The filter "up" with libdeflate's fastest level: of all pairs measured the fastest to write,
  // a tenth larger than the smallest on noisy images.
  constexpr std::uint8_t kUp = 2;
  constexpr int kLevel = 1;
  const auto width = static_cast<std::size_t>(grey.cols);
  thread_local const std::unique_ptr<libdeflate_compressor, FreeCompressor> compressor(
      libdeflate_alloc_compressor(kLevel));
  std::vector<std::uint8_t> filtered((width + 1) * static_cast<std::size_t>(grey.rows));
  const std::vector<std::uint8_t> zeros(width, 0);
  const std::uint8_t* up = zeros.data();
  for (int y = 0; y < grey.rows; ++y) {
    const std::uint8_t* const row = grey.ptr<std::uint8_t>(y);
    std::uint8_t* const out = &filtered[static_cast<std::size_t>(y) * (width + 1)];
    out[0] = kUp;
    for (std::size_t x = 0; x < width; ++x) out[x + 1] = static_cast<std::uint8_t>(row[x] - up[x]);
    up = row;
  }
  std::vector<std::uint8_t> packed(
      libdeflate_zlib_compress_bound(compressor.get(), filtered.size()));
  const std::size_t size = libdeflate_zlib_compress(compressor.get(), filtered.data(),
                                                    filtered.size(), packed.data(), packed.size());
  ROADBOOK_ASSERT(size > 0);

  std::vector<std::uint8_t> header;
  append_big_endian(header, static_cast<std::uint32_t>(grey.cols));
  append_big_endian(header, static_cast<std::uint32_t>(grey.rows));
  header.insert(header.end(), {8, 0, 0, 0, 0});  // 8 bits, grey, deflate, filters, not interlaced
  std::vector<std::uint8_t> file(kSignature.begin(), kSignature.end());
  file.reserve(size + 64);
  append_chunk(file, "IHDR", header);
  append_chunk(file, "IDAT", Bytes(packed).first(size));
  append_chunk(file, "IEND", {});
  return file;
}

cv::Mat half_size(const cv::Mat& grey) {
  if (grey.empty()) return {};
  cv::Mat half(grey.rows / 2, grey.cols / 2, CV_8UC1);
  for (int y = 0; y < half.rows; ++y)
    half_row(grey.ptr<std::uint8_t>(2 * y), grey.ptr<std::uint8_t>(2 * y + 1),
             half.ptr<std::uint8_t>(y), half.cols);
  return half;
}

}  // namespace roadbook
