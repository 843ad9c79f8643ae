#pragma once

#include <Eigen/Geometry>

#include "sim/render/lens.hpp"
#include "sim/render/shading.hpp"
#include "sim/world/mesh.hpp"

namespace roadbook {

/// Fills `hidden` and `own_brightness`, and clears `sees` where the own car hides the whole pixel.
/// The body never moves relative to the cameras, so it is rendered once, with eight rays per pixel.
void see_own_car(const Mesh& own_car,
                 const Shader& shader,
                 const Eigen::Isometry3d& T_vehicle_camera,
                 int num_threads,
                 Lens& lens);

}  // namespace roadbook
