#pragma once

#include <vector>

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Warnings of wheels, steering and gyro of a drive that contradict the poses of its session in the
/// map: catalogued effects with at least 50 nats of evidence that at most one other name explains
/// as well. Each names the sensor, the size with its interval, and the command that shows the
/// evidence. `model`: effects that the map was made with. None for a drive that is no session of
/// the map, or whose readings cannot be judged. Compares the first 400 m of the session. The radius
/// of both wheels is left to the scale of the map (`doubt_of_wheel_scale`). Throws BadInput for a
/// drive that cannot be read.
[[nodiscard]] std::vector<Problem> motion_doubts(const Map& map,
                                                 const Drive& drive,
                                                 const EffectSizes& model);

}  // namespace roadbook
