#pragma once

#include <vector>

#include "drive/drive.hpp"

namespace roadbook {

/// Where the vehicle truly was: `truth/poses` of a simulated drive whose reference poses are those
/// of a map that is scaled or bent, else the reference poses; empty where there are none. For
/// comparison alone: what finds causes or makes maps never asks (a test checks that diagnosis does
/// not). Throws BadInput.
[[nodiscard]] std::vector<TimedPose> true_poses(const Drive& drive);

}  // namespace roadbook
