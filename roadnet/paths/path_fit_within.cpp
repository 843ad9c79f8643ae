#include "roadnet/paths/path_fit_within.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/error.hpp"

namespace roadbook {

PathFit fit_path_within(const std::vector<Eigen::Vector3d>& points,
                        double target_error_m,
                        PathFitOptions options) {
  if (!(target_error_m > 0.0))
    throw InvalidOption("target_error_m", std::to_string(target_error_m), "above 0");
  const auto points_count = static_cast<int>(points.size());
  // Smoothing determines what few points leave open; without it each coefficient needs a point.
  const int most =
      std::max(1, options.smooth_below_m > 0.0 ? points_count / 3
                                               : (points_count - 3) / (options.degree - 2));
  options.segments = std::min(options.segments, most);
  PathFit best = fit_path(points, options);
  while (best.max_deviation_m > target_error_m && options.segments < most) {
    options.segments = std::min(most, options.segments + std::max(1, options.segments / 5));
    try {
      PathFit fit = fit_path(points, options);
      if (fit.max_deviation_m < best.max_deviation_m) best = std::move(fit);
    } catch (const BadInput&) {
      break;  // too many segments: too few points fall into one of them
    }
  }
  return best;
}

}  // namespace roadbook
