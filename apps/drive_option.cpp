#include "apps/drive_option.hpp"

namespace roadbook {

void add_drive_option(Options& options, std::vector<std::filesystem::path>* drives) {
  options.add("--drive", drives, "folder of a session's drive, if it is not where the map says");
}

}  // namespace roadbook
