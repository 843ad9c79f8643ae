#include "workflows/session_drives.hpp"

#include "mapping/store/map_file_disk.hpp"

namespace roadbook {
namespace {

// Returns the session that was made from this drive. The images of another drive would blur the
// overhead image.
std::size_t session_made_of(const Map& map, const Drive& drive) {
  const std::string digest = drive.digest();
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (map.sessions[s].drive_digest == digest) return s;
  throw BadInput({Severity::kError, drive.folder().string(), 0, "drive", "digest " + digest,
                  "a drive the map was made of, unchanged"});
}

}  // namespace

std::filesystem::path session_folder(const std::filesystem::path& map_file,
                                     const Session& session) {
  // operator/ replaces the folder by an absolute drive_path.
  return std::filesystem::absolute(linked_file(map_file)).parent_path() / session.drive_path;
}

std::vector<std::optional<Drive>> open_session_drives(
    const std::filesystem::path& map_file,
    const Map& map,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages) {
  std::vector<std::optional<Drive>> drives(map.sessions.size());
  const auto take = [&](const std::filesystem::path& folder) {
    Drive drive = Drive::open(folder);
    const std::size_t session = session_made_of(map, drive);
    drives[session] = std::move(drive);
  };
  for (const auto& folder : given) take(folder);
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    if (drives[s]) continue;
    const auto folder = session_folder(map_file, map.sessions[s]);
    const auto left_out = [&](const std::string& got) {
      messages.warn(
          {{Severity::kWarning, folder.string(), 0, "drive of session " + map.sessions[s].name, got,
            "the recorded drive (or --drive FOLDER); the session is left out"}});
    };
    if (!std::filesystem::is_directory(folder)) {
      left_out("no such folder");
      continue;
    }
    try {
      take(folder);
    } catch (const BadInput& fault) {  // the other drives are still available
      left_out(fault.problems().front().field + ": " + fault.problems().front().got);
    }
  }
  return drives;
}

}  // namespace roadbook
