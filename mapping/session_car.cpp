#include "mapping/session_car.hpp"

#include <algorithm>

namespace roadbook {

OwnCar own_car_of(const Session& session,
                  const Drive& drive,
                  const std::optional<VehicleMeasures>& given,
                  int num_threads) {
  const bool map_knows = session.vehicle.body().has_value();
  if (given || !map_knows) return find_own_car(drive, given, num_threads);
  OwnCar car = find_own_car(drive, session.vehicle, num_threads);
  car.source = session.vehicle_source;
  return car;
}

std::optional<double> vehicle_width_m(const Map& map) {
  std::optional<double> widest;
  for (const Session& session : map.sessions)
    if (const auto width = session.vehicle.width_or_estimate_m())
      widest = std::max(widest.value_or(0.0), *width);
  return widest;
}

}  // namespace roadbook
