#include "mapping/store/map_file_disk.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {
namespace {

[[noreturn]] void fail_disk(const std::filesystem::path& file, const char* field, int error) {
  throw StorageError(to_line({Severity::kError, file.string(), 0, field, write_fault(file, error),
                              "a disk that takes the file"}));
}

void sync_path(const std::filesystem::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail_disk(path, "open", errno);
  const int code = fsync(descriptor);
  const int fault = errno;
  close(descriptor);
  if (code != 0) fail_disk(path, "fsync", fault);
}

std::filesystem::path journal_of(const std::filesystem::path& file) {
  return linked_file(file) += "-journal";
}

}  // namespace

std::filesystem::path linked_file(std::filesystem::path path) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int i = 0; std::filesystem::is_symlink(path, error); ++i) {
    const auto target = std::filesystem::read_symlink(path, error);
    if (error || i == kMostLinks) fail_disk(path, "link", ELOOP);
    path = path.parent_path() / target;
  }
  return path;
}

void remove_database(const std::filesystem::path& file) {
  for (const std::filesystem::path& path : {file, journal_of(file)}) {
    std::error_code error;
    std::filesystem::remove(path, error);
    if (error) fail_disk(path, "remove", error.value());
  }
}

void replace_file(const std::filesystem::path& file, const std::filesystem::path& name) {
  const std::filesystem::path target = linked_file(name);
  sync_path(file, O_RDONLY);
  recover_database(target);
  std::error_code error;
  std::filesystem::rename(file, target, error);
  if (error) fail_disk(target, "rename", error.value());
  const std::filesystem::path folder = target.parent_path();
  sync_path(folder.empty() ? std::filesystem::path(".") : folder, O_RDONLY | O_DIRECTORY);
}

void recover_database(const std::filesystem::path& file) {
  if (!std::filesystem::exists(journal_of(file)) || !std::filesystem::exists(file)) return;
  // The first read of a connection that may write rolls a hot journal back.
  const SqlDatabase database(file, SqlMode::kReadWrite);
  (void)database.value("SELECT count(*) FROM sqlite_master");
}

}  // namespace roadbook
