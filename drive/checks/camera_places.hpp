#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drive/problem_list.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Where cameras can be on a vehicle, and where they can look.

/// What is wrong with a camera's pose on a vehicle: below the ground, above its roof, far outside
/// the body, a view into the sky or through the own body. Empty where it is a likely pose. `body`
/// is the vehicle's, or an estimate of it.
[[nodiscard]] std::string mounting_fault(const Eigen::Isometry3d& T_vehicle_camera,
                                         const Eigen::AlignedBox3d& body);

/// Whether a fault is a place outside the body, which warn_of_vehicle reports where the body is
/// known.
[[nodiscard]] bool is_outside_fault(const std::string& fault);

/// Warns of cameras that no vehicle carries so. Where most poses are unlikely and the inverses of
/// all of them are likely, the messages say so: Kalibr's T_cam_imu is the inverse of T_BS. Without
/// wheels and vehicle.yaml the frame of the poses may be any body's: then it warns of inverses
/// alone. `sensors`: the folder of the cameras' folders.
void warn_of_camera_places(const std::filesystem::path& sensors,
                           const Rig& rig,
                           const std::optional<WheelModel>& wheels,
                           const std::optional<VehicleMeasures>& vehicle,
                           ProblemList& problems);

}  // namespace roadbook
