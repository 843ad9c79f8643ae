#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace roadbook {

/// Writes the bytes of `text` to `file` without conversion. Throws StorageError if that fails.
void write_text(const std::filesystem::path& file, const std::string& text);

/// A regular file opened for reading. Pipes, sockets, devices and folders are not opened: reading
/// from a pipe without a writer would never end.
class RegularFile {
 public:
  explicit RegularFile(const std::filesystem::path& file);
  /// Whether the file is there, regular and readable.
  explicit operator bool() const { return file_ != nullptr; }
  [[nodiscard]] std::FILE* get() const { return file_.get(); }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Why the file was not opened: "no readable file", "a folder", "a pipe", ...
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t size_ = 0;
  std::string fault_;
};

/// The bytes of a regular file. Throws BadInput where it cannot be read or has more than `most`
/// bytes; `want` names what the file should be ("a YAML file").
[[nodiscard]] std::string read_regular_file(const std::filesystem::path& file,
                                            const std::string& want,
                                            std::uint64_t most = std::uint64_t{1} << 30);

/// Throws BadInput where the path is there but is a pipe, a socket, a device or a folder: for
/// libraries that open a file by its name.
void require_regular_file(const std::filesystem::path& file, const std::string& want);

}  // namespace roadbook
