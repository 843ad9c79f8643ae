#include "apps/session_drives.hpp"

namespace roadbook {

std::filesystem::path session_folder(const std::filesystem::path& map_file,
                                     const Session& session) {
  // An absolute drive_path replaces the folder: that is what operator/ does.
  return std::filesystem::absolute(map_file).parent_path() / session.drive_path;
}

}  // namespace roadbook
