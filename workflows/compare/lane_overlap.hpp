#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook {

using Polyline = std::vector<Eigen::Vector2d>;  ///< plan coordinates [m], two points or more

/// Length of all lines [m].
[[nodiscard]] double total_length_m(const std::vector<Polyline>& lines);

/// Share (0 to 1) of the length of `lines` that lies within `reach_m` of a line of `others`, in
/// plan; in steps of at most 0.1 m. Lines without length give 0.
[[nodiscard]] double share_within(const std::vector<Polyline>& lines,
                                  const std::vector<Polyline>& others,
                                  double reach_m);

}  // namespace roadbook
