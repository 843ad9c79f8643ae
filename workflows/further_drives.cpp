#include "workflows/further_drives.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "mapping/store/existing_map.hpp"
#include "mapping/store/map_file.hpp"
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

[[noreturn]] void refuse_drive(const std::filesystem::path& drive,
                               const std::string& got,
                               const std::string& want) {
  throw BadInput({Severity::kError, drive.string(), 0, "drive", got, want});
}

// Whether `digests` are those of the map's last sessions, in order: a command that extended the map
// by them has been done.
bool ends_with(const std::vector<Session>& sessions, const std::vector<std::string>& digests) {
  return digests.size() <= sessions.size() &&
         std::equal(
             digests.rbegin(), digests.rend(), sessions.rbegin(),
             [](const std::string& digest, const Session& s) { return digest == s.drive_digest; });
}

// Refuses the first of `given` that the map has.
void refuse_known(const std::filesystem::path& map_file,
                  const std::vector<Session>& sessions,
                  const std::vector<std::filesystem::path>& given,
                  const std::vector<std::string>& digests) {
  for (std::size_t i = 0; i < given.size(); ++i)
    for (const Session& session : sessions)
      if (session.drive_digest == digests[i])
        refuse_drive(given[i], "session " + session.name + " of " + map_file.string(),
                     "drives that the map lacks, all its drives in its order, or --replace");
}

}  // namespace

std::vector<std::string> refuse_same_drives(const std::vector<std::filesystem::path>& drives) {
  std::vector<std::string> digests;
  for (const auto& folder : drives) {
    digests.push_back(Drive::open(folder).digest());
    for (std::size_t i = 0; i + 1 < digests.size(); ++i)
      if (digests[i] == digests.back())
        refuse_drive(folder, "the same drive as " + drives[i].string(), "each drive once");
  }
  return digests;
}

FurtherDrives further_drives(const std::filesystem::path& map_file,
                             const std::vector<std::filesystem::path>& given,
                             const Messages& messages) {
  FurtherDrives further;
  const std::vector<std::string> digests = refuse_same_drives(given);
  further.is_new = !std::filesystem::exists(map_file);
  if (further.is_new) return further;
  const std::vector<Session> sessions = load_sessions(map_file);
  std::size_t done = std::min(digests.size(), sessions.size());
  while (done > 0 && !ends_with(sessions, {digests.begin(),
                                           digests.begin() + static_cast<std::ptrdiff_t>(done)}))
    --done;
  further.drives.assign(given.begin() + static_cast<std::ptrdiff_t>(done), given.end());
  refuse_known(map_file, sessions, further.drives,
               {digests.begin() + static_cast<std::ptrdiff_t>(done), digests.end()});
  if (further.drives.empty()) return further;
  const std::size_t count = further.drives.size();
  messages.note("the map of " + std::to_string(sessions.size()) +
                (sessions.size() == 1 ? " session" : " sessions") + " is extended by " +
                std::to_string(count) + (count == 1 ? " drive" : " drives"));
  return further;
}

std::vector<std::filesystem::path> with_drives_of_map(
    const std::filesystem::path& map_file,
    const std::vector<std::filesystem::path>& given,
    const Messages& messages) {
  const std::vector<std::string> digests = refuse_same_drives(given);
  if (!std::filesystem::exists(map_file)) return given;
  const ExistingMap existing = read_existing_map(map_file, digests);
  if (existing.goes_on()) return given;
  const auto& sessions = existing.map.sessions;
  const bool is_done = ends_with(sessions, digests);
  if (!is_done) refuse_known(map_file, sessions, given, digests);
  std::vector<std::filesystem::path> drives;
  for (const Session& session : sessions) drives.push_back(drive_at_hand(map_file, session));
  if (is_done) {
    messages.note("the map of " + existing.names() + " has these drives");
    return drives;
  }
  drives.insert(drives.end(), given.begin(), given.end());
  messages.note("the map of " + existing.names() + " goes on with " + std::to_string(given.size()) +
                (given.size() == 1 ? " further drive" : " further drives"));
  return drives;
}

}  // namespace roadbook
