#pragma once

#include <string>
#include <vector>

#include "diagnosis/hinge.hpp"
#include "diagnosis/view_system.hpp"

namespace roadbook {

inline constexpr std::size_t kHingeAngles = 45;    ///< 4 degrees apart
inline constexpr std::size_t kHingeOffsets = 100;  ///< across the driven place
inline constexpr std::size_t kHingeLines = kHingeAngles * kHingeOffsets;

inline constexpr double kHingeTau = 0.05;  ///< plausible size [rad]

/// A fit to search in.
struct HingeSearch {
  const ViewData& data;
  const ViewNoise& noise;
  const ViewPoint& point;
};

/// Lines in which the ground might bend, best first: those that explain most of how the car climbs,
/// rolls and pitches from keyframe to keyframe in `flat` (linearised there without a hinge).
[[nodiscard]] std::vector<HingeLine> likely_hinges(const HingeSearch& fit, const ViewSystem& flat);

/// "along the line through x = ..., y = ... at ... degrees".
[[nodiscard]] std::string hinge_note(const HingeLine& line);

}  // namespace roadbook
