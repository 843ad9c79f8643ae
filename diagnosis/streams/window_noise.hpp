#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/streams/noise_looks.hpp"
#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// Noise of gyro and steering, by how the readings within a window scatter about a line: nothing of
// the trajectory enters but which half of the windows is the smoother one. One that follows the
// readings has their outliers in its rough half: the share of them wants one of the poses alone.

/// Outliers, variance by speed and turn, correlation, each beside those that are known or sure,
/// appended to `all` with sizes beyond the known; nothing where windows are too few or hold too few
/// readings.
void look_into_windows(const std::string& stream,
                       const std::vector<WindowObservation>& windows,
                       const Trajectory& smooth,
                       const NoiseImperfections& known,
                       std::vector<NoiseCause>& all);

/// Their variance by speed and turn; nothing where windows are too few.
[[nodiscard]] VarianceSlopes window_slopes(const std::string& stream,
                                           const std::vector<WindowObservation>& windows,
                                           const Trajectory& smooth,
                                           const NoiseImperfections& known);

/// Correlation of neighbouring readings, of windows of equal length, less the known one; of fewer
/// than 50 windows none.
[[nodiscard]] NoiseCause correlation_in(const std::string& stream,
                                        const std::vector<const WindowObservation*>& windows,
                                        double known = 0.0);

/// Whether neighbouring readings surely correlate.
[[nodiscard]] bool neighbours_correlate(const std::vector<WindowObservation>& windows,
                                        const Trajectory& smooth);

/// The same of windows with enough readings: their means then share errors, which the trajectory
/// takes for motion as far as it may, and their bias is less sure than the fit has it.
[[nodiscard]] bool readings_correlate(const std::vector<WindowObservation>& windows,
                                      const Trajectory& smooth);

/// Standard deviation of a window's mean that makes a mean over many windows as uncertain as a
/// process of the first order does; 0 where `readings_correlate` does not hold.
[[nodiscard]] double slow_noise_of_mean(const std::vector<WindowObservation>& windows,
                                        const Trajectory& smooth);

}  // namespace roadbook
