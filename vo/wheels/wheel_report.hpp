#pragma once

#include <cstdint>
#include <vector>

#include "vo/keyframe_track.hpp"
#include "vo/wheels/wheel_correction.hpp"
#include "vo/wheels/wheel_doubts.hpp"

namespace roadbook {

/// Puts the doubts of a comparison into words. Times count from `origin_ns`. `all`: the drive was
/// mapped without any of the wheels' motions.
[[nodiscard]] SensorDoubt describe_doubts(const WheelComparison& comparison,
                                          const VoResult& sight,
                                          std::int64_t origin_ns,
                                          bool all);

/// Puts a mistake of wiring or calibration into words. `comparison`: of the wheels as recorded.
[[nodiscard]] SensorDoubt describe_correction(const WheelCorrection& correction,
                                              const WheelComparison& comparison,
                                              const VoResult& sight,
                                              std::int64_t origin_ns);

/// Puts times into words in which corners fit no motion near that of the wheels, and the cameras
/// alone know none, so that the wheels stayed in use. The wheels or the cameras may be the cause.
[[nodiscard]] SensorDoubt describe_unknown(const std::vector<TimeSpan>& spans,
                                           std::int64_t origin_ns);

/// Puts into words that the corners or the ground contradict the wheels, and that the cameras alone
/// know too little of the motion to judge: the share `known`.
[[nodiscard]] SensorDoubt describe_unjudged(double known);

}  // namespace roadbook
