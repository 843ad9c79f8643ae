#pragma once

#include <string>

#include "diagnosis/views/hinge.hpp"
#include "diagnosis/views/view_prediction.hpp"

namespace roadbook {

inline constexpr std::size_t kHingeLines = 4500;  ///< that are looked at
inline constexpr double kHingeTau = 0.05;         ///< plausible size [rad]

/// Lays hinges of size 0 into `point` and counts them in `basis`, instead of those before: lines in
/// which the ground might bend, best first. Those that explain most of how the car climbs, rolls
/// and pitches from keyframe to keyframe, turned and shifted to where they explain most of
/// everything with poses and landmarks free.
void lay_hinges(const ViewData& data,
                const ViewNoise& noise,
                int num_threads,
                ViewBasis& basis,
                ViewPoint& point);

/// "along the line through x = ..., y = ... at ... degrees".
[[nodiscard]] std::string hinge_note(const HingeLine& line);

}  // namespace roadbook
