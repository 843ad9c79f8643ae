#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// The vehicle seen from above, a rectangle in its frame: origin on the rear axle, x forward.
struct VehicleFootprint {
  double length_m = 4.5;
  double width_m = 1.9;
  double rear_overhang_m = 0.9;  ///< behind the rear axle

  /// Throws InvalidOption.
  void check() const;

  /// Its corners [m, map frame], wider by `clearance_m` on all sides. The rear axle is at `place`
  /// and the vehicle looks along `heading` (unit).
  [[nodiscard]] std::vector<Eigen::Vector2d> at(const Eigen::Vector2d& place,
                                                const Eigen::Vector2d& heading,
                                                double clearance_m) const;
};

/// The footprint of a body in the vehicle frame. Its width is twice that of the wider half.
[[nodiscard]] VehicleFootprint footprint_of(const Eigen::AlignedBox3d& body);

/// A car of the default size, enlarged on each side as much as the vehicles that recorded the map.
/// The ground that those vehicles drove along is free for both.
[[nodiscard]] VehicleFootprint footprint_for(const Map& map);

}  // namespace roadbook
