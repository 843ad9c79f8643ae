#pragma once

#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/motion/motion_model.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {

/// Appends noise effects of the wheels' readings to `all`, with sizes in addition to the known
/// ones: outliers, and variance by speed (if it grows) and by turn. The scatter that accumulates
/// along the way is modelled as well. Appends nothing if `wheel_windows` has too few windows, or if
/// an encoder's tick is larger than the scatter of the readings.
void look_into_wheels(const Observations& obs,
                      const MotionModel& model,
                      const NoiseImperfections& known,
                      std::vector<NoiseCause>& all);

}  // namespace roadbook
