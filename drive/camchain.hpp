#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "drive/problem_list.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

/// Whether a file name is that of a camchain of Kalibr or roadbook: camchain.yaml,
/// camchain-imucam-BAG.yaml (Kalibr until 2020), BAG-camchain.yaml and BAG-camchain-imucam.yaml
/// (Kalibr since then).
[[nodiscard]] bool is_camchain_name(std::string_view name);
/// Returns such files in the folder, ordered by name.
[[nodiscard]] std::vector<std::filesystem::path> camchain_files(
    const std::filesystem::path& folder);

/// Compares each of Kalibr's camchain.yaml files with the rig of the sensor.yaml files, camera by
/// camera of the same name. Another model or resolution, parameters that differ by more than 1e-6
/// of their size, a pose (T_cam_imu * T_BS; among the cameras where the chain knows no body) off
/// the identity by more than 1e-6 and a stated time offset off by more than 1e-6 s are errors that
/// name file, camera and field; they are warnings where another file, which states as much, agrees
/// with the rig. A camera that only one of the two knows is a warning.
void check_camchains(const std::vector<std::filesystem::path>& files,
                     const Rig& rig,
                     ProblemList& problems);

}  // namespace roadbook
