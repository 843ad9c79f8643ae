#pragma once

namespace roadbook {

/// Positions farther apart in height belong to different floors.
inline constexpr double kFloorHeight_m = 1.5;

}  // namespace roadbook
