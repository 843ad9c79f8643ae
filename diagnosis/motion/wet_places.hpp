#pragma once

#include <vector>

#include "diagnosis/motion/motion_library.hpp"
#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

// Places where the wheels may slip: discs along the way. A long drive has many, and each would be a
// column of the elimination. A first pass over the nominal residuals selects a few of them, so that
// the cost stays linear in the length of the drive.

inline constexpr const char* kWetPatch = "wheels0.wet_patch";

/// Discs of one size every two metres of the way, each place once. Their penalty accounts for the
/// number of places considered.
[[nodiscard]] std::vector<Candidate> wet_places(const Trajectory& trajectory);

/// Those `most` of the places, in their order, whose score before projection is greatest: product
/// of the column with the gradient of the smoothed fit over the column's own square.
[[nodiscard]] std::vector<Candidate> telling_places(const Observations& obs,
                                                    const MotionModel& model,
                                                    const std::vector<Candidate>& places,
                                                    std::size_t most = 24);

/// Discs near a place, of several sizes: where exactly do the wheels slip?
[[nodiscard]] std::vector<Candidate> places_near(const Observations& obs,
                                                 const MotionPoint& point,
                                                 const Candidate& place);

/// Up to three places where the wheels slip so clearly that the noise must not be estimated without
/// them, each with the catalogued effects and the places before it in the model. Empty if there
/// would be a fourth. The model's residual must be that of its point.
[[nodiscard]] std::vector<Accepted> slipping_places(const Observations& obs,
                                                    const MotionModel& model);

}  // namespace roadbook
