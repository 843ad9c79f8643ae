#include "apps/output_option.hpp"

#include <system_error>

#include "base/error.hpp"

namespace roadbook {

void refuse_to_replace(const std::filesystem::path& map,
                       const std::filesystem::path& output,
                       const char* option) {
  std::error_code error;
  if (std::filesystem::equivalent(map, output, error))
    throw InvalidOption(option, output.string() + ", the map itself", "another file");
}

}  // namespace roadbook
