#pragma once

#include <cstdint>

#include "vo/keyframe_track.hpp"
#include "vo/wheels/wheel_doubts.hpp"

namespace roadbook {

/// Puts the doubts of a comparison into words. Times count from `origin_ns`. `all`: the drive was
/// mapped without any of the wheels' motions.
[[nodiscard]] SensorDoubt describe_doubts(const WheelComparison& comparison,
                                          const VoResult& sight,
                                          std::int64_t origin_ns,
                                          bool all);

}  // namespace roadbook
