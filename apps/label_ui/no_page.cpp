#include "apps/label_server/http/page_files.hpp"

namespace roadbook {

std::optional<PageFile> page_file(std::string_view) { return std::nullopt; }

}  // namespace roadbook
