#pragma once

#include <vector>

#include "diagnosis/inference/noise_cause.hpp"
#include "diagnosis/motion/motion_model.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {

/// Noise of the wheels' readings, appended to `all` with sizes beyond the known: outliers, variance
/// by speed (where it grows) and by turn, beside what the wheels scatter on their way. Nothing
/// where `wheel_windows` has too few, or an encoder's tick rounds by more than readings scatter.
void look_into_wheels(const Observations& obs,
                      const MotionModel& model,
                      const NoiseImperfections& known,
                      std::vector<NoiseCause>& all);

}  // namespace roadbook
