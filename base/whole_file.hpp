#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// A file that appears under its name only when it is complete: written under another name, then
/// renamed.
///
/// Write to `part()`, then call `commit`; without `commit` the part is removed. A device or a pipe
/// is written in place (`part()` is the path itself). Throws StorageError.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  [[nodiscard]] const std::filesystem::path& part() const { return part_; }
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;  ///< keeps the extension, by which writers choose a format
};

/// Writes the text through a WholeFile. Throws StorageError.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

/// Returns "DIR/stem_NAME.ext" for "DIR/stem.ext". In NAME, all characters other than letters,
/// digits, '-' and '.' become '_'.
[[nodiscard]] std::filesystem::path with_suffix(const std::filesystem::path& path,
                                                const std::string& name);

}  // namespace roadbook
