#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"
#include "diagnosis/streams/variance_samples.hpp"

namespace roadbook {

// Noise of gyro and steering from the scatter of readings about a line within windows. The
// trajectory is only used to select the smoother half of the windows. It must come from the poses
// alone if the share of outliers is estimated: a trajectory that follows the readings puts their
// outliers in its rough half.

/// Appends to `all` the noise effects of a stream: outliers, variance by speed and turn rate,
/// correlation. Each is estimated with the known and the significant ones in the model; sizes are
/// those beyond `known`. Appends nothing if there are too few windows or readings.
void append_window_noise(const std::string& stream,
                         const std::vector<WindowObservation>& windows,
                         const Trajectory& smooth,
                         const NoiseImperfections& known,
                         std::vector<NoiseCause>& all);

/// Variance of the windows by speed and turn rate; only the known part if there are too few
/// windows.
[[nodiscard]] VarianceSlopes window_slopes(const std::string& stream,
                                           const std::vector<WindowObservation>& windows,
                                           const Trajectory& smooth,
                                           const NoiseImperfections& known);

/// Correlation of neighbouring readings minus the known one, from windows with the usual number of
/// readings. Size 0 for fewer than 50 windows.
[[nodiscard]] NoiseCause correlation_in(const std::string& stream,
                                        const std::vector<const WindowObservation*>& windows,
                                        double known = 0.0);

/// True if the correlation of neighbouring readings is significant.
[[nodiscard]] bool neighbours_correlate(const std::vector<WindowObservation>& windows,
                                        const Trajectory& smooth);

/// The same for windows with enough readings. The means of windows then share errors. The
/// trajectory absorbs much of them as motion, and the true uncertainty of their bias exceeds that
/// of the fit.
[[nodiscard]] bool readings_correlate(const std::vector<WindowObservation>& windows,
                                      const Trajectory& smooth);

/// Standard deviation of a window's mean such that the mean of many windows is as uncertain as that
/// of the first-order process; 0 unless `readings_correlate`.
[[nodiscard]] double slow_noise_of_mean(const std::vector<WindowObservation>& windows,
                                        const Trajectory& smooth);

}  // namespace roadbook
