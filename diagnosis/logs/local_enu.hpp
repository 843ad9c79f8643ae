#pragma once

#include <Eigen/Core>

namespace roadbook {

// Conversion of WGS84 latitude, longitude and ellipsoidal height to a local east, north, up frame.

struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;
};

/// Earth-centred, earth-fixed coordinates [m]. Exact.
[[nodiscard]] Eigen::Vector3d earth_fixed(const Geodetic& g);

/// East, north, up [m] of `point` relative to `origin`: the axes are tangential to the ellipsoid at
/// `origin`. Exact.
[[nodiscard]] Eigen::Vector3d local_enu(const Geodetic& point, const Geodetic& origin);

}  // namespace roadbook
