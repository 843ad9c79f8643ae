#include "mapping/store/map_reading.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "mapping/store/map_file_open.hpp"

namespace roadbook {

MapReading::MapReading(std::filesystem::path map)
    : map_(std::move(map)),
      descriptor_(open(existing_map_file(map_).c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw StorageError(to_line(
        {Severity::kError, map_.string(), 0, "map", std::strerror(errno), "a readable file"}));
}

MapReading::~MapReading() { close(descriptor_); }

void MapReading::require_same_map() const {
  struct stat begun {};
  struct stat now {};
  if (fstat(descriptor_, &begun) == 0 && stat(map_.c_str(), &now) == 0 &&
      begun.st_dev == now.st_dev && begun.st_ino == now.st_ino)
    return;
  throw StorageError(
      to_line({Severity::kError, map_.string(), 0, "map",
               "another map in its place while it was read", "the same command again"}));
}

}  // namespace roadbook
