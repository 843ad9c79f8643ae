#pragma once

#include <string>
#include <vector>

#include "base/random.hpp"
#include "sensors/vehicle.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/mesh.hpp"
#include "sim/world/texture.hpp"

namespace roadbook {

/// Size and paint of a car body.
struct CarShape {
  double length_m = 4.2;
  double width_m = 1.76;
  double height_m = 1.46;
  double bonnet = 0.28;   ///< share of the length
  double boot = 0.02;     ///< share of the length
  double paint = 120.0;   ///< grey level
  double front_m = 3.45;  ///< x of the front bumper; x = 0 is the rear axle's middle
  double wheelbase_m = 2.58;
  std::string plate;
};

/// The measuring car's body.
[[nodiscard]] CarShape own_car_shape();

/// Content of vehicle.yaml of a simulated drive: measures of the body and axles of `vehicle`. Axles
/// that do not fit into the body are left out.
[[nodiscard]] VehicleMeasures vehicle_measures(const VehicleSpec& vehicle);

/// Body with windows, lamps, plates, wheels, in the vehicle frame. Its textures are appended.
[[nodiscard]] Mesh make_car(const CarShape& shape,
                            SurfaceClass kind,
                            std::vector<Texture>& textures,
                            Random& random);

/// One of the `kCarModels` shapes of other people's cars.
[[nodiscard]] CarShape car_shape(int model, Random& random);

}  // namespace roadbook
