#include "drive/images/image_header.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace roadbook {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
constexpr std::array<std::uint8_t, 8> kPngEnd = {'I', 'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
constexpr std::array<std::uint8_t, 2> kJpegEnd = {0xFF, 0xD9};
constexpr std::size_t kHead = 512;
constexpr std::size_t kTail = 64;  // cameras append a few bytes behind the end marker

std::uint32_t big_endian(const std::uint8_t* p, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | p[i];
  return value;
}

// Content by position, from a file or from memory.
class Source {
 public:
  explicit Source(Bytes content) : memory_(content), size_(content.size()) {}
  explicit Source(const std::filesystem::path& file)
      : fd_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat status {};
    if (fd_ >= 0 && ::fstat(fd_, &status) == 0 && S_ISREG(status.st_mode))
      size_ = static_cast<std::uint64_t>(status.st_size);
    else
      good_ = false;
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() {
    if (fd_ >= 0) ::close(fd_);
  }

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// As many bytes as there are, up to the size of `to`.
  std::size_t read(std::uint64_t offset, std::span<std::uint8_t> to) const {
    if (offset >= size_) return 0;
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(to.size(), size_ - offset));
    if (fd_ < 0) {
      std::memcpy(to.data(), memory_.data() + offset, count);
      return count;
    }
    const ssize_t got = ::pread(fd_, to.data(), count, static_cast<off_t>(offset));
    return got > 0 ? static_cast<std::size_t>(got) : 0;
  }

 private:
  Bytes memory_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
  bool good_ = true;
};

template <std::size_t N>
bool ends_with(const Source& source, const std::array<std::uint8_t, N>& marker) {
  std::array<std::uint8_t, kTail> tail{};
  const std::uint64_t offset = source.size() > kTail ? source.size() - kTail : 0;
  const std::size_t count = source.read(offset, tail);
  const auto end = tail.begin() + static_cast<std::ptrdiff_t>(count);
  return std::search(tail.begin(), end, marker.begin(), marker.end()) != end;
}

// FNV-1a, which takes nanoseconds: a PNG's tail holds the checksum of its last pixels.
std::uint64_t tail_hash(const Source& source) {
  std::array<std::uint8_t, kTail> tail{};
  const std::uint64_t offset = source.size() > kTail ? source.size() - kTail : 0;
  const std::size_t count = source.read(offset, tail);
  std::uint64_t hash = 14695981039346656037u;
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ tail[i]) * 1099511628211u;
  return hash;
}

bool valid_png_type(int bits, int colour) {
  switch (colour) {
    case 0:
      return bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16;
    case 3:
      return bits == 1 || bits == 2 || bits == 4 || bits == 8;
    case 2:
    case 4:
    case 6:
      return bits == 8 || bits == 16;
    default:
      return false;
  }
}

void read_png(const Source& source, Bytes head, ImageHeader& header) {
  header.format = ImageFormat::kPng;
  // Signature 8, length 4, "IHDR", width 4, height 4, bits, colour type, compression, filter,
  // interlace.
  constexpr std::size_t kNeeded = 33;
  if (head.size() < kNeeded) {
    header.state = ImageState::kTruncated;
    return;
  }
  const std::uint8_t* const p = head.data();
  const std::uint32_t width = big_endian(p + 16, 4);
  const std::uint32_t height = big_endian(p + 20, 4);
  const int colour = p[25];
  header.bits = p[24];
  header.interlaced = p[28] == 1;
  const bool sound = big_endian(p + 8, 4) == 13 && std::memcmp(p + 12, "IHDR", 4) == 0 &&
                     width > 0 && height > 0 && width <= 0x7fffffffu && height <= 0x7fffffffu &&
                     valid_png_type(header.bits, colour) && p[26] == 0 && p[27] == 0 && p[28] <= 1;
  if (!sound) {
    header.state = ImageState::kDamaged;
    return;
  }
  header.width = width;
  header.height = height;
  header.channels = colour == 2 || colour == 3 ? 3 : colour == 6 ? 4 : colour == 4 ? 2 : 1;
  header.state = ends_with(source, kPngEnd) ? ImageState::kGood : ImageState::kTruncated;
}

bool is_frame_header(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

void read_jpeg(const Source& source, ImageHeader& header) {
  header.format = ImageFormat::kJpeg;
  header.state = ImageState::kDamaged;
  // Segments are FF, marker, length (2, counting itself), content. Real files have some dozen
  // before the frame header.
  constexpr int kMaxSegments = 4096;
  std::uint64_t offset = 2;
  for (int segment = 0; segment < kMaxSegments; ++segment) {
    std::array<std::uint8_t, 10> p{};
    const std::size_t got = source.read(offset, p);
    if (got < p.size()) {
      header.state = ImageState::kTruncated;
      return;
    }
    if (p[0] != 0xFF) return;
    if (p[1] == 0xFF) {  // fill byte
      ++offset;
      continue;
    }
    if (is_frame_header(p[1])) {
      header.bits = p[4];
      header.height = big_endian(&p[5], 2);
      header.width = big_endian(&p[7], 2);
      header.channels = p[9];
      const bool sound = header.width > 0 && header.height > 0 && header.bits >= 8 &&
                         header.bits <= 16 && header.channels >= 1 && header.channels <= 4;
      if (sound)
        header.state = ends_with(source, kJpegEnd) ? ImageState::kGood : ImageState::kTruncated;
      return;
    }
    const std::uint32_t length = big_endian(&p[2], 2);
    if (length < 2 || p[1] == 0xD9 || p[1] == 0xDA) return;
    offset += 2 + length;
  }
}

ImageHeader inspect(const Source& source) {
  ImageHeader header;
  if (!source.good()) return header;
  header.bytes = source.size();
  header.tail = tail_hash(source);
  std::array<std::uint8_t, kHead> buffer{};
  const Bytes head = Bytes(buffer).first(source.read(0, buffer));
  header.state = head.size() < kPngSignature.size() ? ImageState::kTruncated : ImageState::kUnknown;
  if (head.size() >= kPngSignature.size() &&
      std::equal(kPngSignature.begin(), kPngSignature.end(), head.begin()))
    read_png(source, head, header);
  else if (head.size() >= 3 && head[0] == 0xFF && head[1] == 0xD8 && head[2] == 0xFF)
    read_jpeg(source, header);
  return header;
}

}  // namespace

ImageHeader inspect_image(const std::filesystem::path& file) { return inspect(Source(file)); }

ImageHeader inspect_image(std::span<const std::uint8_t> content) {
  return inspect(Source(content));
}

std::string to_text(ImageState state) {
  switch (state) {
    case ImageState::kGood:
      return "a good image";
    case ImageState::kMissing:
      return "no such file";
    case ImageState::kUnknown:
      return "neither PNG nor JPEG";
    case ImageState::kDamaged:
      return "a damaged header";
    case ImageState::kTruncated:
      return "a file cut short";
  }
  return "";
}

}  // namespace roadbook
