#include "workflows/map_copy.hpp"

#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "mapping/store/map_file_disk.hpp"
#include "mapping/store/map_file_lock.hpp"

namespace roadbook {

MapCopy::MapCopy(std::filesystem::path map, const char* suffix)
    : map_(std::move(map)), file_(beside(map_, suffix)) {
  remove_files();  // a killed process may have left them
}

MapCopy::~MapCopy() { remove_files(); }

void MapCopy::remove_files() const {
  std::error_code ignored;
  for (const auto& file : {file_, beside(file_, ".part"), beside(file_, ".new")})
    std::filesystem::remove(file, ignored);
}

void MapCopy::begin_with_map() const {
  std::error_code error;
  std::filesystem::copy_file(map_, file_, error);
  if (error)
    throw StorageError("error: " + file_.string() + ": got " + error.message() +
                       ", want a copy of " + map_.string());
}

void MapCopy::put_in_place() { replace_file(file_, linked_file(map_)); }

}  // namespace roadbook
