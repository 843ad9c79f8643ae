#pragma once

namespace roadbook {

inline constexpr double kFloorHeight_m =
    1.5;  ///< What is farther apart in height is another floor.

}  // namespace roadbook
