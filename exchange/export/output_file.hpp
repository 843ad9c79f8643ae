#pragma once

#include <filesystem>
#include <string>

namespace roadbook {

/// A file that appears under its name only when it is whole: written beside it, then renamed.
///
/// `part()` is where to write. Without `commit` it is removed again. Throws StorageError.
class ExportedFile {
 public:
  explicit ExportedFile(std::filesystem::path path);
  ~ExportedFile();
  ExportedFile(const ExportedFile&) = delete;
  ExportedFile& operator=(const ExportedFile&) = delete;

  [[nodiscard]] const std::filesystem::path& part() const { return part_; }
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;
};

/// Writes the whole text by way of an ExportedFile.
void write_text_file(const std::filesystem::path& path, const std::string& text);

/// "DIR/stem_NAME.ext" of "DIR/stem.ext"; in NAME all but letters, digits, '-', '.' become '_'.
[[nodiscard]] std::filesystem::path with_suffix(const std::filesystem::path& path,
                                                const std::string& name);

}  // namespace roadbook
