#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace roadbook {

struct PageFile {
  std::string_view type;  ///< MIME
  std::string_view bytes;
};

/// A file of the labelling page as it was built into the program; empty for other names, and for
/// all where the program was built without npm.
[[nodiscard]] std::optional<PageFile> page_file(std::string_view path);

}  // namespace roadbook
