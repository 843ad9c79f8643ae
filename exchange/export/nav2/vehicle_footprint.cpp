#include "exchange/export/nav2/vehicle_footprint.hpp"

#include <algorithm>
#include <string>

#include "base/error.hpp"

namespace roadbook {

void VehicleFootprint::check() const {
  const auto require = [](const char* name, double value, double least, double most) {
    if (!(value >= least && value <= most))
      throw InvalidOption(name, std::to_string(value),
                          std::to_string(least) + " to " + std::to_string(most));
  };
  require("vehicle length_m", length_m, 0.2, 30.0);
  require("vehicle width_m", width_m, 0.2, 5.0);
  require("vehicle rear_overhang_m", rear_overhang_m, 0.0, length_m);
}

std::vector<Eigen::Vector2d> VehicleFootprint::at(const Eigen::Vector2d& place,
                                                  const Eigen::Vector2d& heading,
                                                  double clearance_m) const {
  const Eigen::Vector2d back = place - (rear_overhang_m + clearance_m) * heading;
  const Eigen::Vector2d along = (length_m + 2.0 * clearance_m) * heading;
  const Eigen::Vector2d half =
      (0.5 * width_m + clearance_m) * Eigen::Vector2d(-heading.y(), heading.x());
  return {back - half, back + along - half, back + along + half, back + half};
}

VehicleFootprint footprint_of(const Eigen::AlignedBox3d& body) {
  return {body.max().x() - body.min().x(), 2.0 * std::max(body.max().y(), -body.min().y()),
          -body.min().x()};
}

VehicleFootprint footprint_for(const Map& map) {
  VehicleFootprint most;
  double front_m = most.length_m - most.rear_overhang_m;
  for (const Session& session : map.sessions)
    if (const auto body = session.vehicle.body()) {
      const VehicleFootprint one = footprint_of(*body);
      front_m = std::max(front_m, one.length_m - one.rear_overhang_m);
      most.rear_overhang_m = std::max(most.rear_overhang_m, one.rear_overhang_m);
      most.width_m = std::max(most.width_m, one.width_m);
    }
  most.length_m = front_m + most.rear_overhang_m;
  return most;
}

}  // namespace roadbook
