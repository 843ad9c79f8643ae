#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace roadbook {

// Files that a drive's writer makes. Every failure throws StorageError and names the file.

/// Throws StorageError "error: PATH: WHAT: got WHY, want ..."; without `why` the reason that errno
/// holds.
[[noreturn]] void throw_storage_error(const std::filesystem::path& path,
                                      const std::string& what,
                                      const std::string& why);
[[noreturn]] void throw_storage_error(const std::filesystem::path& path, const std::string& what);

/// With all folders above it.
void make_folder(const std::filesystem::path& folder);

/// Written front to back. Without `close` the last bytes may be missing, unreported.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();
  void write(std::string_view bytes);
  void close();

 private:
  std::filesystem::path path_;
  std::FILE* file_;
};

void write_file(const std::filesystem::path& path, std::string_view bytes);

enum class StampOrder { kAscends, kRepeats };

/// FOLDER/data.csv, with its header from the start.
class OutputTable {
 public:
  OutputTable(const std::filesystem::path& folder, std::string_view header);
  /// Stamps ascend (asserted), or at least do not descend.
  void row(std::int64_t t_ns, std::string_view rest, StampOrder order = StampOrder::kAscends);
  void close();

 private:
  OutputFile file_;
  std::int64_t last_ns_ = -1;
};

}  // namespace roadbook
