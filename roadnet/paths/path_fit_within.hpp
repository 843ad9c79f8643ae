#pragma once

#include "roadnet/paths/path_fit.hpp"

namespace roadbook {

/// `fit_path` with as many segments as a target needs: from `options.segments` (or fewer, where the
/// points are few) a fifth more at a time until no point is farther than `target_error_m` from the
/// curve. The number is `path.segments()`.
///
/// The points bear only so many segments: where those are not enough, the best fit is returned and
/// `max_deviation_m` says by how much it misses. Throws as `fit_path`, and InvalidOption for a
/// target that is not above 0.
[[nodiscard]] PathFit fit_path_within(const std::vector<Eigen::Vector3d>& points,
                                      double target_error_m,
                                      PathFitOptions options = {});

}  // namespace roadbook
