#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

namespace roadbook {

/// A pose as a line of a TUM trajectory, with its end of line: `timestamp tx ty tz qx qy qz qw`,
/// the time in seconds with nine decimals.
[[nodiscard]] std::string tum_line(std::int64_t t_ns, const Eigen::Isometry3d& T_map_vehicle);

}  // namespace roadbook
