#include "mapping/pipeline/map_paths.hpp"

#include <iterator>
#include <system_error>

#include "mapping/store/map_file_disk.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& map) { return fs::absolute(linked_file(map)).parent_path(); }

bool climbs(const fs::path& relative) { return !relative.empty() && *relative.begin() == ".."; }

// "link/../drive" is another folder than "drive" if link is a symbolic link.
bool goes_back(const fs::path& path) {
  bool is_after_name = false;
  for (const fs::path& part : path.relative_path()) {
    if (part == ".." && is_after_name) return true;
    is_after_name |= part != ".." && part != ".";
  }
  return false;
}

bool reaches_root(const fs::path& relative, const fs::path& map) {
  const fs::path folder = fs::weakly_canonical(folder_of(map)).relative_path();
  const auto depth = std::distance(folder.begin(), folder.end());
  std::ptrdiff_t ups = 0;
  for (const fs::path& part : relative) ups += part == ".." ? 1 : 0;
  return depth > 0 && ups >= depth;
}

// Name of a file that shares no folder with the map.
std::string name_in_drive(const fs::path& file, const std::vector<fs::path>& drives) {
  for (const fs::path& drive : drives) {
    const fs::path folder = fs::absolute(drive / "").lexically_normal().parent_path();
    const fs::path inside = fs::absolute(file).lexically_normal().lexically_relative(folder);
    if (inside.empty() || climbs(inside)) continue;
    return inside == "." ? folder.filename().string() : (folder.filename() / inside).string();
  }
  return file.filename().string();
}

}  // namespace

std::string path_from_map(const fs::path& file, const fs::path& map) {
  const fs::path folder = folder_of(map);
  fs::path named =
      fs::absolute(file).lexically_normal().lexically_relative(folder.lexically_normal());
  if (!named.has_filename()) named = named.parent_path();  // "drive/"
  if (!climbs(named) && !goes_back(file) && !goes_back(map)) return named.string();
  std::error_code failed;
  const fs::path real = fs::relative(file, folder, failed);
  return (failed || real.empty() ? named : real).string();
}

std::vector<Problem> problems_from_map(std::vector<Problem> problems,
                                       const std::vector<fs::path>& drives,
                                       const fs::path& map) {
  for (Problem& problem : problems) {
    if (problem.file.empty()) continue;
    const std::string relative = path_from_map(problem.file, map);
    problem.file = reaches_root(relative, map) ? name_in_drive(problem.file, drives) : relative;
  }
  return problems;
}

}  // namespace roadbook
