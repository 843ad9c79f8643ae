#include "apps/write_file.hpp"

#include <fstream>
#include <system_error>

#include "base/error.hpp"

namespace roadbook {

void write_file(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  // A device or a pipe is written to, not replaced.
  const auto there = std::filesystem::status(file, error);
  const bool in_place = std::filesystem::exists(there) && !std::filesystem::is_regular_file(there);
  const std::filesystem::path part = in_place ? file.string() : file.string() + ".part";
  {
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    if (!out.write(text.data(), static_cast<std::streamsize>(text.size())).flush()) {
      out.close();
      if (!in_place) std::filesystem::remove(part, error);
      throw StorageError("error: " + file.string() + ": got a failed write, want a writable file");
    }
  }
  if (in_place) return;
  std::filesystem::rename(part, file, error);
  if (error)
    throw StorageError(
        to_line({Severity::kError, file.string(), 0, "", error.message(), "a writable file"}));
}

void refuse_to_replace(const std::filesystem::path& map, const std::filesystem::path& output) {
  std::error_code error;
  if (std::filesystem::equivalent(map, output, error))
    throw InvalidOption("--output", output.string() + ", the map itself", "another file");
}

}  // namespace roadbook
