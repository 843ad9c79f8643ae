#pragma once

#include <Eigen/Core>

namespace roadbook {

// Latitude, longitude and height above the ellipsoid WGS84 as east, north and up of a first point.

struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;
};

/// Earth-centred, earth-fixed coordinates [m]; exact on the ellipsoid.
[[nodiscard]] Eigen::Vector3d earth_fixed(const Geodetic& g);

/// East, north, up [m] of `point` on the plane that touches the ellipsoid's parallel surface at
/// `origin`: exact, no flat-earth approximation.
[[nodiscard]] Eigen::Vector3d local_enu(const Geodetic& point, const Geodetic& origin);

}  // namespace roadbook
