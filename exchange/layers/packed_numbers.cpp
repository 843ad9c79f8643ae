#include "exchange/layers/packed_numbers.hpp"

#include <libdeflate.h>

#include <memory>

#include "base/error.hpp"

namespace roadbook {

Bytes packed_bytes(std::span<const std::uint8_t> bytes) {
  constexpr int kLevel = 9;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
  ROADBOOK_ASSERT(compressor != nullptr);
  Bytes packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                         packed.data(), packed.size()));
  ROADBOOK_ASSERT(!packed.empty());
  return packed;
}

std::optional<Bytes> unpacked_bytes(const Bytes& packed, std::size_t size) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
      decompressor(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  ROADBOOK_ASSERT(decompressor != nullptr);
  Bytes bytes(size);
  // Without a place for the size, the call fails unless exactly `size` bytes come out.
  if (libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), bytes.data(),
                                 size, nullptr) != LIBDEFLATE_SUCCESS)
    return std::nullopt;
  return bytes;
}

}  // namespace roadbook
