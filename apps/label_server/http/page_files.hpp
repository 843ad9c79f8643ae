#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace roadbook {

struct PageFile {
  std::string_view type;  ///< MIME
  std::string_view bytes;
};

/// Returns a file of the labelling page that is built into the program. Empty for other names, and
/// for all names if the program was built without npm.
[[nodiscard]] std::optional<PageFile> page_file(std::string_view path);

}  // namespace roadbook
