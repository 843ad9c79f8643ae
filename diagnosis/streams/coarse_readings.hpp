#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

// Steering and gyro readings that are quantised in steps larger than their noise. The scatter of
// such readings is that of rounding: none for a long time, then one step. It would be mistaken for
// outliers and autocorrelation. A rounding error is at most half a step and stays while the reading
// stays.

/// Quantisation step of the readings, if it is larger than their scatter within windows; else 0.
[[nodiscard]] double coarse_step(std::vector<double> readings,
                                 const std::vector<WindowObservation>& windows);

/// Standard deviation of the rounding error: uniform over one step.
[[nodiscard]] double rounding_sigma(double step);

/// For each window the number of windows that hold nothing but the same level, itself included.
/// Readings at one level share one rounding error. 1 if the readings of the window change.
[[nodiscard]] std::vector<std::size_t> windows_alike(const std::vector<WindowObservation>& windows,
                                                     double step);

/// Windows from which the noise of steering or gyro can be estimated; empty for coarse readings.
[[nodiscard]] const std::vector<WindowObservation>& windows_of_noise(const Observations& obs,
                                                                     Channel channel);

/// One line of text for each stream with coarse readings.
[[nodiscard]] std::vector<std::string> coarse_readings(const Observations& obs);

}  // namespace roadbook
