#include "exchange/export/tum_line.hpp"

#include <array>
#include <cstdio>

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

}  // namespace

std::string tum_line(std::int64_t t_ns, const Eigen::Isometry3d& T_map_vehicle) {
  const Eigen::Vector3d p = T_map_vehicle.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(T_map_vehicle.linear()).normalized();
  std::array<char, 400> pose{};
  std::snprintf(pose.data(), pose.size(), " %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", p.x(), p.y(),
                p.z(), q.x(), q.y(), q.z(), q.w());
  return seconds_text(t_ns) + pose.data();
}

}  // namespace roadbook
