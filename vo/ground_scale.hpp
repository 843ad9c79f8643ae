#pragma once

#include <optional>
#include <vector>

namespace roadbook {

/// The scale of a reconstruction, found from the ground.
struct GroundScale {
  double scale = 1.0;  ///< factor on lengths that gives the camera its height by calibration
  double sigma = 0.0;  ///< standard deviation, relative
  int support = 0;     ///< points in the mode
};

/// Scale from the camera's height over the ground.
///
/// `height_ratios[i]` = (camera height by calibration) / (depth of point i below the camera, in the
/// units of the reconstruction). Points of the ground agree on one value. All other points lie
/// above the ground and give larger values. The result is the mode of the ratios on a logarithmic
/// axis. Empty if fewer than `min_support` points lie near the mode.
[[nodiscard]] std::optional<GroundScale> ground_scale(std::vector<double> height_ratios,
                                                      int min_support = 12);

}  // namespace roadbook
