#include "diagnosis/logs/local_enu.hpp"

#include <cmath>

namespace roadbook {

Eigen::Vector3d earth_fixed(const Geodetic& g) {
  constexpr double kSemiMajor = 6378137.0;
  constexpr double kFlattening = 1.0 / 298.257223563;
  constexpr double kE2 = kFlattening * (2.0 - kFlattening);
  const double sin_lat = std::sin(g.latitude_rad);
  const double cos_lat = std::cos(g.latitude_rad);
  const double N = kSemiMajor / std::sqrt(1.0 - kE2 * sin_lat * sin_lat);
  return {(N + g.height_m) * cos_lat * std::cos(g.longitude_rad),
          (N + g.height_m) * cos_lat * std::sin(g.longitude_rad),
          (N * (1.0 - kE2) + g.height_m) * sin_lat};
}

Eigen::Vector3d local_enu(const Geodetic& point, const Geodetic& origin) {
  const Eigen::Vector3d d = earth_fixed(point) - earth_fixed(origin);
  const double sin_lat = std::sin(origin.latitude_rad), cos_lat = std::cos(origin.latitude_rad);
  const double sin_lon = std::sin(origin.longitude_rad), cos_lon = std::cos(origin.longitude_rad);
  return {-sin_lon * d.x() + cos_lon * d.y(),
          -sin_lat * cos_lon * d.x() - sin_lat * sin_lon * d.y() + cos_lat * d.z(),
          cos_lat * cos_lon * d.x() + cos_lat * sin_lon * d.y() + sin_lat * d.z()};
}

}  // namespace roadbook
