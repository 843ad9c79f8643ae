#pragma once

#include <array>
#include <vector>

#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

/// What the rows leave once all named effects are fitted, and how much of each channel's noise that
/// is.
struct Saturated {
  std::vector<std::vector<double>> squares;  ///< of each channel's rows
  std::vector<double> redundancy;            ///< sums over each channel's rows
  std::vector<double> view_square;           ///< of each observation, sum of both
  std::vector<double> scatter;   ///< of each camera, see LandmarkScatter and ImageScatter
  std::array<double, 6> sway{};  ///< of each axis of the motions, see sway_ratios
};

/// Fits all causes at once, held by their plausible sizes about those of `known`, and moves `point`
/// (at which `system` was linearised) to where that leads.
[[nodiscard]] Saturated saturate(const ViewSystem& system,
                                 const std::vector<ViewCause>& causes,
                                 const ViewBasis& basis,
                                 const ViewData& data,
                                 const EffectSizes& known,
                                 ViewPoint& point);

/// Noise by what a saturated fit at `noise` leaves: of motions and ground the scale; of views scale
/// and tails, whose freedom is written to `freedom` (of each camera).
void renew_noise(const Saturated& saturated,
                 const ViewData& data,
                 ViewNoise& noise,
                 std::vector<double>& freedom);

}  // namespace roadbook
