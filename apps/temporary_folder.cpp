#include "apps/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/error.hpp"

namespace roadbook {

TemporaryFolder::TemporaryFolder() {
  std::error_code failed;
  const auto place = std::filesystem::temp_directory_path(failed);
  std::string pattern = (place / "roadbook_XXXXXX").string();
  if (failed || ::mkdtemp(pattern.data()) == nullptr)
    throw StorageError("error: " + pattern + ": folder: got " + std::strerror(errno) +
                       ", want one to write to");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace roadbook
