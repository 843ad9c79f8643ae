#pragma once

#include <optional>
#include <string>

#include "diagnosis/inference/diagnosis_result.hpp"
#include "sensors/rig.hpp"

namespace roadbook {

/// New values of one camera in the keys of its `sensor.yaml`, as an order to the reader: "set
/// `intrinsics` of cam2 to [416, 416.2, 640.1, 400.3] (stated: [412, 412.2, 640.1, 400.3])".
///
/// The values are right when all effects of this camera in `d` are corrected together. Effects of
/// the whole rig are not part of them. Empty for an effect of the whole rig, for one that is
/// neither of the lens nor of the mounting, and if `stated` does not have the camera.
[[nodiscard]] std::optional<std::string> new_camera_values(const Diagnosis& d,
                                                           const std::string& effect,
                                                           const Rig& stated);

}  // namespace roadbook
