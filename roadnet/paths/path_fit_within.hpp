#pragma once

#include "roadnet/paths/path_fit.hpp"

namespace roadbook {

/// Calls `fit_path` with as many segments as a target error needs. Starts with `options.segments`
/// (or fewer if there are few points) and adds a fifth until no point is farther than
/// `target_error_m` from the curve. The result has `path.segments()` segments.
///
/// The number of points limits the number of segments. If the limit is reached before the target,
/// returns the best fit; `max_deviation_m` tells its error. Throws as `fit_path`, and InvalidOption
/// for a target that is not above 0.
[[nodiscard]] PathFit fit_path_within(const std::vector<Eigen::Vector3d>& points,
                                      double target_error_m,
                                      PathFitOptions options = {});

}  // namespace roadbook
