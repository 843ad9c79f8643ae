#pragma once

#include <filesystem>

namespace roadbook {

/// Locks a folder, so that one process at a time writes into it. The lock is the system's own
/// (flock): a killed process leaves none behind, and the folder has no file for it.
class FolderLock {
 public:
  /// Throws StorageError that names the process that holds the lock. A file system without locks
  /// gives none, and no error.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace roadbook
