#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/random.hpp"

namespace roadbook {

// Faults of recordings and of calibrations, as users make them. Each changes the files of a drive.

/// What was damaged. A message that holds one of `sensors` names the sensor; one that also holds
/// one of `causes` names the cause.
struct PlantedFault {
  std::vector<std::string> sensors;   ///< folders of the drive: "wheels0", "cam2"
  std::vector<std::string> causes{};  ///< "focal length"; empty: the sensor is all that can be said
};

/// One kind of fault. The random engine draws the side, the camera, the time and the sign.
struct DriveFault {
  std::string name;  ///< "wheels: stuck 2 s, one"
  std::function<PlantedFault(const std::filesystem::path& drive, Random&)> plant;
};

/// Faults of the wheels: counters that stand, jump, wrap or run backwards; wrong measures.
[[nodiscard]] std::vector<DriveFault> wheel_faults();

/// Faults of the cameras: wrong calibrations, swapped, late, frozen or unreadable images. The drive
/// has cameras cam0 to cam3.
[[nodiscard]] std::vector<DriveFault> camera_faults();

}  // namespace roadbook
