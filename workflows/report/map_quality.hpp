#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// How well the observations of a map agree with its poses and landmarks.
struct MapQuality {
  std::vector<float> residuals_px;  ///< of every observation [px of the full-size image]
  std::size_t behind_camera = 0;    ///< observations whose landmark is behind the camera
  std::vector<int> observations_of_keyframe;
  std::vector<int> views_of_landmark;
};

/// Projects the landmark of every observation into its camera. Takes time in proportion to the
/// number of observations.
[[nodiscard]] MapQuality measure_quality(const Map& map);

/// Returns NaN if there are no values.
[[nodiscard]] double sample_quantile(std::vector<double> values, double q);

/// Returns the vehicle position at each keyframe, in the plane of the map [m].
[[nodiscard]] std::vector<Eigen::Vector2d> driven_positions(const Map& map);

/// Returns the length that all sessions drove together [m].
[[nodiscard]] double driven_m(const Map& map);

}  // namespace roadbook
