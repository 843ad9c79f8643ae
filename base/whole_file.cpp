#include "base/whole_file.hpp"

#include <cctype>
#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"

namespace roadbook {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& got) {
  throw StorageError(to_line({Severity::kError, path.string(), 0, "output", got,
                              "a writable place with room on its disk"}));
}

}  // namespace

WholeFile::WholeFile(std::filesystem::path path) : path_(std::move(path)), part_(path_) {
  std::error_code error;
  const auto there = std::filesystem::status(path_, error);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) return;
  part_.replace_filename(path_.stem().string() + ".part" + path_.extension().string());
  std::filesystem::remove(part_, error);
  if (error) fail(part_, error.message());
}

WholeFile::~WholeFile() {
  std::error_code ignored;
  if (part_ != path_) std::filesystem::remove(part_, ignored);
}

void WholeFile::commit() {
  if (part_ == path_) return;
  std::error_code error;
  std::filesystem::rename(part_, path_, error);
  if (error) fail(path_, write_fault(path_, error.value()));
}

void write_whole_file(const std::filesystem::path& path, const std::string& text) {
  WholeFile output(path);
  errno = 0;
  std::ofstream stream(output.part(), std::ios::binary | std::ios::trunc);
  stream << text;
  stream.close();
  if (!stream) fail(path, write_fault(output.part(), errno));
  output.commit();
}

std::filesystem::path with_suffix(const std::filesystem::path& path, const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const bool kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    safe += kept ? c : '_';
  }
  std::filesystem::path result = path;
  return result.replace_filename(path.stem().string() + "_" + safe + path.extension().string());
}

}  // namespace roadbook
