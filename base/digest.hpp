#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace roadbook {

/// Incremental SHA-256 (FIPS 180-4). Not for concurrent use.
class Sha256 {
 public:
  Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();

  Sha256& update(std::span<const std::byte> bytes);
  Sha256& update(std::string_view text);
  /// The number's eight bytes, least significant first: the same on every machine.
  Sha256& update(std::uint64_t number);
  Sha256& update(std::int64_t number) { return update(static_cast<std::uint64_t>(number)); }
  /// The bit pattern of the number; -0.0 and 0.0 differ.
  Sha256& update(double number);
  /// The whole content of a file, streamed. Throws StorageError if it cannot be read.
  Sha256& update_file(const std::filesystem::path& file);

  /// Returns 64 lower-case hex digits of everything added, and starts a new digest.
  [[nodiscard]] std::string hex();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

[[nodiscard]] std::string sha256_hex(std::string_view text);
/// The same of a file's content. Throws StorageError.
[[nodiscard]] std::string sha256_file_hex(const std::filesystem::path& file);

}  // namespace roadbook
