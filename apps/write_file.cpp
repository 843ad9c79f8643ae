#include "apps/write_file.hpp"

#include <fstream>
#include <system_error>

#include "base/error.hpp"

namespace roadbook {

void write_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path part = file.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    if (!out.write(text.data(), static_cast<std::streamsize>(text.size())).flush())
      throw StorageError("error: " + file.string() + ": got a failed write, want a writable file");
  }
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) throw StorageError("error: " + file.string() + ": " + error.message());
}

}  // namespace roadbook
