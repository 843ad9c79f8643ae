#include "exchange/vehicle_footprint.hpp"

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

}  // namespace roadbook
