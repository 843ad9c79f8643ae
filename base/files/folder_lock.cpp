#include "base/files/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"
#include "base/files/lock_holder.hpp"

namespace roadbook {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw StorageError(
        to_line({Severity::kError, folder.string(), 0, "lock", std::strerror(errno), "a folder"}));
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  close(descriptor_);
  throw StorageError(to_line({Severity::kError, folder.string(), 0, "lock",
                              "a folder that " + lock_holder(folder) + " is writing",
                              "the end of that process, then the same command again"}));
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace roadbook
