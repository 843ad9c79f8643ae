#include <set>

#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/tum_line.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {
namespace {

std::string tum_text(const Map& map, int session) {
  std::string text;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (map.keyframes[i].session != session) continue;
    text += tum_line(map.keyframes[i].t_ns, map.T_map_vehicle(static_cast<int>(i)));
  }
  return text;
}

}  // namespace

Paths export_tum(const std::filesystem::path& map_file, const std::filesystem::path& out) {
  const Map map = load_map(map_file);
  if (map.sessions.empty())
    throw BadInput(
        Problem{Severity::kError, map_file.string(), 0, "sessions", "none", "at least one"});
  Paths files;
  std::set<std::filesystem::path> taken;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    std::filesystem::path file = out;
    if (map.sessions.size() > 1) {
      file = with_suffix(out, map.sessions[s].name);
      // The same drive name twice must not overwrite the first.
      for (int n = 2; !taken.insert(file).second; ++n)
        file = with_suffix(out, map.sessions[s].name + "-" + std::to_string(n));
    }
    write_whole_file(file, tum_text(map, static_cast<int>(s)));
    files.push_back(file);
  }
  return files;
}

}  // namespace roadbook
