#pragma once

#include <vector>

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/motion/motion_fit.hpp"

namespace roadbook {

// Candidates for places where the wheels may slip (puddles, ice): discs along the way.

inline constexpr const char* kWetPatch = "wheels0.wet_patch";
inline constexpr double kPuddleRadius_m = 3.0;  ///< radius of the discs of `wet_places`

/// Discs of one size every two metres of the way, each place once. Their penalty is the logarithm
/// of the number of places.
[[nodiscard]] std::vector<Candidate> wet_places(const Trajectory& trajectory);

/// Variants of a disc for a refined search: both ends moved by up to half a metre, and discs of
/// radius 1.5 to 6 m around the poses within 3 m of its centre.
[[nodiscard]] std::vector<Candidate> places_near(const Observations& obs,
                                                 const MotionPoint& point,
                                                 const Candidate& place);

}  // namespace roadbook
