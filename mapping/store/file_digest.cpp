#include "mapping/store/file_digest.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <utility>
#include <vector>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "base/files/disk_space.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kDigits = 64;
constexpr std::string_view kMark = "sha256:";
using Range = std::pair<std::size_t, std::size_t>;  // begin, size
// Of SQLite's header: journal mode; change counter; version for which it is valid, and of SQLite.
constexpr std::array<Range, 3> kChanging{{{18, 2}, {24, 4}, {92, 8}}};

std::string no_digest() { return std::string(kMark) + std::string(kDigits, '0'); }

[[noreturn]] void fail_reading(const std::filesystem::path& file) {
  throw StorageError(to_line({Severity::kError, file.string(), 0, "file digest",
                              write_fault(file, errno), "a file that can be read and written"}));
}

/// A file's bytes, to be read.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (descriptor < 0 || fstat(descriptor, &status) != 0) fail_reading(file);
    size_ = static_cast<std::size_t>(status.st_size);
    bytes_ = mmap(nullptr, size_, PROT_READ, MAP_SHARED, descriptor, 0);
    close(descriptor);
    if (bytes_ == MAP_FAILED) fail_reading(file);
  }
  ~MappedFile() { munmap(bytes_, size_); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view view() const { return {static_cast<const char*>(bytes_), size_}; }

 private:
  void* bytes_ = nullptr;
  std::size_t size_ = 0;
};

// Places of the digits of `stored`. SQLite may leave a copy of the row in the room between rows.
std::vector<Range> places_of(std::string_view bytes, const std::string& stored) {
  const std::string row = kFileDigestKey + stored;  // a row's texts follow each other
  std::vector<Range> places;
  for (std::size_t at = bytes.find(row); at != std::string_view::npos; at = bytes.find(row, at + 1))
    places.emplace_back(at + row.size() - kDigits, kDigits);
  return places;
}

std::string digest_without(std::string_view bytes, std::vector<Range> places) {
  places.insert(places.end(), kChanging.begin(), kChanging.end());
  std::sort(places.begin(), places.end());
  Sha256 digest;
  std::size_t at = 0;
  for (const auto& [begin, size] : places) {
    digest.update(bytes.substr(at, begin - at)).update(std::string(size, '0'));
    at = begin + size;
  }
  return digest.update(bytes.substr(at)).hex();
}

}  // namespace

void reserve_file_digest(const SqlDatabase& database) {
  database.prepare("INSERT INTO map_meta(key, value) VALUES(?, ?)")
      .bind_text(1, kFileDigestKey)
      .bind_text(2, no_digest())
      .run();
}

void write_file_digest(const std::filesystem::path& file) {
  std::vector<Range> places;
  std::string digest;
  {
    const MappedFile mapped(file);
    places = places_of(mapped.view(), no_digest());
    ROADBOOK_ASSERT(!places.empty());
    digest = digest_without(mapped.view(), places);
  }
  const int descriptor = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  bool written = descriptor >= 0;
  for (const auto& [begin, size] : places)
    written = written && pwrite(descriptor, digest.data(), size, static_cast<off_t>(begin)) ==
                             static_cast<ssize_t>(size);
  if (descriptor >= 0) written = close(descriptor) == 0 && written;
  if (!written) fail_reading(file);
}

bool has_sealed_bytes(const std::filesystem::path& file, const std::string& stored) {
  if (stored.empty()) return true;
  if (stored.size() != kMark.size() + kDigits) return false;
  const MappedFile mapped(file);
  return digest_without(mapped.view(), places_of(mapped.view(), stored)) ==
         stored.substr(kMark.size());
}

}  // namespace roadbook
