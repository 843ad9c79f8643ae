#pragma once

#include <vector>

#include "diagnosis/views/view_system.hpp"

namespace roadbook {

// Whether the errors of a camera's views go together that have no landmark in common, as they do
// where whole images are shifted, turned or stretched.
//
//   Q = sum over images k, l of 0.9^|k-l| a_k b_l,
//
// of either axis, where a_k is the sum of what is left of image k's views of one half of the
// landmarks and b_l of image l's views of the other half: so nothing is multiplied with what the
// same landmark leaves. That is Q of a shift; that of a turn or a stretch has sums weighted by
// either coordinate in the image, and the smaller probability counts as that of two. Q is taken in
// units of the sum of squares, and compared with draws in which the errors of each landmark, as
// they are left, have a random sign and go through the projection again. In these, too, trajectory
// and landmarks follow all views of an image at once, which makes Q differ from zero without a
// cause, and a corner that is set wrong errs alike in all its views, which makes Q scatter more
// than independent views would.

/// Of each camera the probability that Q is as large without errors that landmarks have in common,
/// where the system was linearised. Linear in the number of views; deterministic.
[[nodiscard]] std::vector<double> image_whiteness(const ViewSystem& system, const ViewData& data);

}  // namespace roadbook
