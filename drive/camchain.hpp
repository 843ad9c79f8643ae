#pragma once

#include <filesystem>

#include "drive/problem_list.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

/// Compares a Kalibr camchain.yaml with the rig of the sensor.yaml files, camera by camera of the
/// same name. Another model or resolution, parameters that differ by more than 1e-6 of their size,
/// a pose (T_cam_imu * T_BS; among the cameras where the chain knows no body) off the identity by
/// more than 1e-6 and a time offset off by more than 1e-6 s are errors that name file, camera and
/// field; a camera that only one of the two knows is a warning.
void check_camchain(const std::filesystem::path& file, const Rig& rig, ProblemList& problems);

}  // namespace roadbook
