#pragma once

#include <optional>
#include <vector>

namespace roadbook {

struct GroundScale {
  double scale = 1.0;  ///< factor that brings the ground to where the calibration says it is
  double sigma = 0.0;  ///< relative
  int support = 0;     ///< points in the mode
};

/// Scale from the camera's height over the ground.
///
/// `height_ratios[i]` = (camera height by calibration) / (depth of point i below the camera, in the
/// units of the reconstruction): points of the ground agree on one value, all others lie above the
/// ground and vote for larger ones. The densest place on a logarithmic axis is taken. Empty with
/// fewer than `min_support` points near it.
[[nodiscard]] std::optional<GroundScale> ground_scale(std::vector<double> height_ratios,
                                                      int min_support = 12);

}  // namespace roadbook
