#include "workflows/further_drives.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "mapping/store/existing_map.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

// Returns the drive of a session at the path stored in the map. The drive must be unchanged.
std::filesystem::path drive_at_hand(const std::filesystem::path& map_file, const Session& session) {
  const auto folder = session_folder(map_file, session);
  const auto refuse = [&](const std::string& got) {
    throw BadInput({Severity::kError, folder.string(), 0, "drive of session " + session.name, got,
                    "the drive the map was made of, which a further one is mapped with (or all "
                    "drives, in the order of the map)"});
  };
  if (!std::filesystem::is_directory(folder)) refuse("no such folder");
  if (Drive::open(folder).digest() != session.drive_digest) refuse("another drive");
  return folder.lexically_normal();
}

}  // namespace

std::vector<std::filesystem::path> with_drives_of_map(
    const std::filesystem::path& map_file,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages) {
  if (!std::filesystem::exists(map_file)) return given;
  std::vector<std::string> digests;
  for (const auto& folder : given) digests.push_back(Drive::open(folder).digest());
  const ExistingMap existing = read_existing_map(map_file, digests);
  if (existing.goes_on()) return given;
  const auto& sessions = existing.map.sessions;
  std::vector<std::filesystem::path> further;
  for (std::size_t i = 0; i < given.size(); ++i)
    if (std::none_of(sessions.begin(), sessions.end(),
                     [&](const Session& s) { return s.drive_digest == digests[i]; }))
      further.push_back(given[i]);
  if (further.empty()) return given;  // fewer drives than the map has: only with --replace
  std::vector<std::filesystem::path> drives;
  for (const Session& session : sessions) drives.push_back(drive_at_hand(map_file, session));
  drives.insert(drives.end(), further.begin(), further.end());
  messages.note("the map of " + existing.names() + " goes on with " +
                std::to_string(further.size()) +
                (further.size() == 1 ? " further drive" : " further drives"));
  return drives;
}

}  // namespace roadbook
