#pragma once

#include <vector>

#include "drive/drive.hpp"

namespace roadbook {

/// Where the vehicle truly was: `truth/poses` of a simulated drive whose reference poses are those
/// of a map that is scaled or bent, else the reference poses; empty where there are none. For
/// comparison alone: what finds causes never asks (a test checks), and of what makes maps only the
/// summary, which says how far off the finished map is. Throws BadInput.
[[nodiscard]] std::vector<TimedPose> true_poses(const Drive& drive);

}  // namespace roadbook
