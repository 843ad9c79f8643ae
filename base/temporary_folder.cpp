#include "base/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/error.hpp"

namespace roadbook {

TemporaryFolder::TemporaryFolder() {
  std::error_code failed;
  const auto place = std::filesystem::temp_directory_path(failed);
  if (failed)
    throw StorageError("error: TMPDIR: got " + failed.message() + ", want a folder to write to");
  std::string pattern = (place / "roadbook_XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    const int reason = errno;  // before anything else has a chance to set it
    throw StorageError("error: " + pattern + ": folder: got " + std::strerror(reason) +
                       ", want one to write to");
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace roadbook
