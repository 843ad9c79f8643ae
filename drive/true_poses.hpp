#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"

namespace roadbook {

/// Returns the true poses of the vehicle: `truth/poses` of a simulated drive if its reference poses
/// are wrong on purpose (a scaled or bent map), else the reference poses. Empty if the drive has
/// neither. Only for evaluation: diagnosis never reads them (a test checks this), and mapping reads
/// them only for the error in its summary. Throws BadInput.
[[nodiscard]] std::vector<TimedPose> true_poses(const Drive& drive);

/// Returns the name of the simulated place in whose frame the true poses lie: scenario, size and
/// seed of `truth/world.json`, such as "zurich, size small, seed 11". The true poses of two drives
/// are comparable if the names are equal. Empty for a recorded drive, whose reference has a frame
/// of its own, and for a simulated drive without these keys.
[[nodiscard]] std::optional<std::string> true_world(const Drive& drive);

}  // namespace roadbook
