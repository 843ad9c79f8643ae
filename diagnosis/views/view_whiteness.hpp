#pragma once

#include <vector>

#include "diagnosis/views/view_system.hpp"

namespace roadbook {

// Test for errors that are common to the views of a camera on different landmarks, as if whole
// images were shifted, turned or stretched. The statistic for either axis is
//
//   Q = sum over images k, l of 0.9^|k-l| a_k b_l,
//
// where a_k is the sum of the residuals of image k on one half of the landmarks, and b_l that of
// image l on the other half. No residual is multiplied with one of the same landmark. A turn or a
// stretch uses sums weighted by the pixel coordinates; the smaller of both p-values is corrected
// for two tests.
//
// Q is divided by the sum of squares and compared with draws under the null hypothesis: the
// residuals of each landmark get a common random sign and are projected again. The draws thus
// include two effects of the fit: poses and landmarks follow all views of an image, which gives Q a
// mean; and misplaced corners err alike in all views, which widens its distribution.

/// The p-value of each camera under the null hypothesis of no common errors, at the point of
/// linearisation. Linear in the number of views; deterministic.
[[nodiscard]] std::vector<double> image_whiteness(const ViewSystem& system, const ViewData& data);

}  // namespace roadbook
