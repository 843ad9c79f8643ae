#include "mapping/store/map_file_disk.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "base/error.hpp"
#include "mapping/store/map_file_sqlite.hpp"

namespace roadbook {
namespace {

[[noreturn]] void fail_disk(const std::filesystem::path& file,
                            const char* field,
                            const std::string& got) {
  throw StorageError(
      to_line({Severity::kError, file.string(), 0, field, got, "a disk that takes the file"}));
}

void sync_path(const std::filesystem::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail_disk(path, "open", std::strerror(errno));
  const int code = fsync(descriptor);
  const int fault = errno;
  close(descriptor);
  if (code != 0) fail_disk(path, "fsync", std::strerror(fault));
}

std::filesystem::path journal_of(std::filesystem::path file) { return file += "-journal"; }

}  // namespace

void remove_database(const std::filesystem::path& file) {
  for (const std::filesystem::path& path : {file, journal_of(file)}) {
    std::error_code error;
    std::filesystem::remove(path, error);
    if (error) fail_disk(path, "remove", error.message());
  }
}

void replace_file(const std::filesystem::path& file, const std::filesystem::path& target) {
  sync_path(file, O_RDONLY);
  recover_database(target);
  std::error_code error;
  std::filesystem::rename(file, target, error);
  if (error) fail_disk(target, "rename", error.message());
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
