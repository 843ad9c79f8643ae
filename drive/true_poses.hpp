#pragma once

#include <vector>

#include "drive/drive.hpp"

namespace roadbook {

/// Returns the true poses of the vehicle: `truth/poses` of a simulated drive if its reference poses
/// are wrong on purpose (a scaled or bent map), else the reference poses. Empty if the drive has
/// neither. Only for evaluation: diagnosis never reads them (a test checks this), and mapping reads
/// them only for the error in its summary. Throws BadInput.
[[nodiscard]] std::vector<TimedPose> true_poses(const Drive& drive);

}  // namespace roadbook
