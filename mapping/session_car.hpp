#pragma once

#include <optional>

#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "vo/own_car_mask.hpp"

namespace roadbook {

/// The own car of a session's drive: `given` measures, else those that the map knows of the
/// session, else what `find_own_car` finds. `source` says where the measures first came from.
[[nodiscard]] OwnCar own_car_of(const Session& session,
                                const Drive& drive,
                                const std::optional<VehicleMeasures>& given,
                                int num_threads);

/// Greatest width of the vehicles that the map was recorded with, as stated or estimated; empty
/// where no session knows it.
[[nodiscard]] std::optional<double> vehicle_width_m(const Map& map);

}  // namespace roadbook
