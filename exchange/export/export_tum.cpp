#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <set>

#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {
namespace {

/// Seconds with nine decimals from the integer: a double would lose the last three digits.
std::string seconds_text(std::int64_t t_ns) {
  // The magnitude as unsigned: the smallest integer has no positive twin.
  const std::uint64_t magnitude =
      t_ns < 0 ? 0U - static_cast<std::uint64_t>(t_ns) : static_cast<std::uint64_t>(t_ns);
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%s%llu.%09llu", t_ns < 0 ? "-" : "",
                static_cast<unsigned long long>(magnitude / 1'000'000'000U),
                static_cast<unsigned long long>(magnitude % 1'000'000'000U));
  return text.data();
}

std::string tum_text(const Map& map, int session) {
  std::string text;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    if (map.keyframes[i].session != session) continue;
    const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(i));
    const Eigen::Vector3d p = T.translation();
    const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
    std::array<char, 400> pose{};
    std::snprintf(pose.data(), pose.size(), " %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", p.x(), p.y(),
                  p.z(), q.x(), q.y(), q.z(), q.w());
    text += seconds_text(map.keyframes[i].t_ns) + pose.data();
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
