#include "base/digest.hpp"

#include <openssl/evp.h>

#include <array>
#include <bit>
#include <fstream>
#include <vector>

#include "base/error.hpp"
#include "base/text_file.hpp"

namespace roadbook {

struct Sha256::Impl {
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context{EVP_MD_CTX_new(),
                                                                  &EVP_MD_CTX_free};
  Impl() { start(); }
  void start() {
    ROADBOOK_ASSERT(context != nullptr);
    ROADBOOK_ASSERT(EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
  }
};

Sha256::Sha256() : impl_(std::make_unique<Impl>()) {}
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
Sha256::~Sha256() = default;

Sha256& Sha256::update(std::span<const std::byte> bytes) {
  ROADBOOK_ASSERT(EVP_DigestUpdate(impl_->context.get(), bytes.data(), bytes.size()) == 1);
  return *this;
}

Sha256& Sha256::update(std::string_view text) { return update(std::as_bytes(std::span(text))); }

Sha256& Sha256::update(std::uint64_t number) {
  std::array<std::byte, 8> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = static_cast<std::byte>((number >> (8 * i)) & 0xff);
  return update(std::span<const std::byte>(bytes));
}

Sha256& Sha256::update(double number) { return update(std::bit_cast<std::uint64_t>(number)); }

Sha256& Sha256::update_file(const std::filesystem::path& file) {
  require_regular_file(file, "a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw StorageError("error: " + file.string() + ": got no readable file");
  std::vector<char> buffer(1u << 20);
  while (in) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    update(std::string_view(buffer.data(), static_cast<std::size_t>(in.gcount())));
  }
  if (in.bad())
    throw StorageError("error: " + file.string() + ": reading: got a failure, want the whole file");
  return *this;
}

std::string Sha256::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  ROADBOOK_ASSERT(EVP_DigestFinal_ex(impl_->context.get(), digest.data(), &size) == 1);
  impl_->start();
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    text += kDigits[digest[i] >> 4];
    text += kDigits[digest[i] & 15];
  }
  return text;
}

std::string sha256_hex(std::string_view text) { return Sha256().update(text).hex(); }

std::string sha256_file_hex(const std::filesystem::path& file) {
  return Sha256().update_file(file).hex();
}

}  // namespace roadbook
