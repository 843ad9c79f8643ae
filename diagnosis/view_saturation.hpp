#pragma once

#include <vector>

#include "diagnosis/view_fit.hpp"

namespace roadbook {

/// A view beyond so many standard deviations with all named effects free is an outlier.
inline constexpr double kViewGate = 4.0;

/// What the rows leave once all named effects are fitted, and how much of each channel's noise that
/// is.
struct Saturated {
  std::vector<std::vector<double>> squares;  ///< of each channel's rows
  std::vector<double> redundancy;            ///< sums over each channel's rows
  std::vector<double> view_square;           ///< of each observation, sum of both
  std::vector<double> inflation;             ///< of each camera, see TrackCorrelation
};

/// Fits all causes at once, held by their plausible sizes, and moves `point` to where that leads.
[[nodiscard]] Saturated saturate(const ViewSystem& system,
                                 const std::vector<ViewCause>& causes,
                                 const ViewBasis& basis,
                                 const ViewData& data,
                                 ViewPoint& point);

/// Noise by what a saturated fit at `noise` leaves.
void renew_noise(const Saturated& saturated, const ViewChannels& channels, ViewNoise& noise);

}  // namespace roadbook
