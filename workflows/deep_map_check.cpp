#include "workflows/deep_map_check.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/checks/deep_check.hpp"
#include "mapping/store/map_file.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

// The recordings of the map that are where it says and unchanged.
std::vector<std::optional<Drive>> drives_at_hand(const std::filesystem::path& file,
                                                 const Map& map,
                                                 const Messages& messages) {
  std::vector<std::optional<Drive>> drives;
  std::string missing;
  for (const Session& session : map.sessions) {
    drives.emplace_back();
    const auto folder = session_folder(file, session);
    try {
      if (std::filesystem::is_directory(folder)) {
        Drive drive = Drive::open(folder);
        if (drive.digest() == session.drive_digest) drives.back() = std::move(drive);
      }
    } catch (const BadInput&) {
      // Not the recording that the map was made of.
    }
    if (!drives.back()) missing += (missing.empty() ? "" : ", ") + session.name;
  }
  if (!missing.empty())
    messages.note("descriptors of session " + missing +
                  " are not compared: the recording is missing");
  return drives;
}

}  // namespace

MapReport check_map_deep(const std::filesystem::path& file,
                         int num_threads,
                         const Messages& messages) {
  MapReport report = check_map(file);
  if (!report.problems.empty()) return report;
  const Map map = load_map(file);
  report.problems = deep_map_problems(map);
  const auto drives = drives_at_hand(file, map, messages);
  std::vector<const Drive*> at_hand;
  for (const auto& drive : drives) at_hand.push_back(drive ? &*drive : nullptr);
  for (Problem& problem : descriptor_problems(map, at_hand, num_threads))
    report.problems.push_back(std::move(problem));
  for (Problem& problem : report.problems) problem.file = file.string();
  return report;
}

}  // namespace roadbook
