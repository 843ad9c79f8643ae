#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

// Steering and gyro that are read in steps coarser than their noise. How such readings scatter is
// how they were rounded: none for long, then a step, which looks like outliers and correlation. A
// rounding error is within half a step, and stands as long as the reading does.

/// Step of the grid that readings stand on, where it is coarser than what they scatter by in their
/// windows; else 0.
[[nodiscard]] double coarse_step(std::vector<double> readings,
                                 const std::vector<WindowObservation>& windows);

/// Standard deviation of the error of rounding to `step`: uniform.
[[nodiscard]] double rounding_sigma(double step);

/// Of each window how many, itself among them, read nothing but its level: an angle that is held,
/// or come back to, is rounded alike, and all of them have one error in common. 1 where readings
/// change.
[[nodiscard]] std::vector<std::size_t> windows_alike(const std::vector<WindowObservation>& windows,
                                                     double step);

/// Windows whose scatter tells of the noise of steering or gyro: none of coarse readings.
[[nodiscard]] const std::vector<WindowObservation>& windows_of_noise(const Observations& obs,
                                                                     Channel channel);

/// A line for each stream of coarse readings.
[[nodiscard]] std::vector<std::string> coarse_readings(const Observations& obs);

}  // namespace roadbook
