#include "base/files/disk_space.hpp"

#include <sys/statvfs.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace roadbook {
namespace {

// A write may fail although a little room is left: writers ask for many blocks at once.
constexpr std::uint64_t kFullBytes = 256 << 10;

bool is_full(const std::filesystem::path& folder) {
  struct statvfs disk {};
  return statvfs(folder.c_str(), &disk) == 0 && disk.f_blocks > 0 &&
         (disk.f_bavail * disk.f_frsize < kFullBytes || (disk.f_files > 0 && disk.f_favail == 0));
}

}  // namespace

std::string write_fault(const std::filesystem::path& file, int error) {
  const std::filesystem::path parent = file.parent_path();
  const std::filesystem::path folder = parent.empty() ? std::filesystem::path(".") : parent;
  const bool says_so = error == ENOSPC || error == EDQUOT;
  if (says_so || is_full(folder))
    return "no space left on the device holding " + (says_so ? file : folder).string();
  return error == 0 ? "a failed write" : std::strerror(error);
}

}  // namespace roadbook
