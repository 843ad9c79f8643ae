#include "base/text_file.hpp"

#include <fstream>

#include "base/error.hpp"

namespace roadbook {

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.flush();
  if (!out)
    throw StorageError("error: " + file.string() +
                       ": writing: got a failure, want a disk that takes it");
}

}  // namespace roadbook
