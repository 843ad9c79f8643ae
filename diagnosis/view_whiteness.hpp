#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "diagnosis/view_system.hpp"

namespace roadbook {

// Whether the errors of a camera's views go together that have no landmark in common, as they do
// where whole images are shifted.
//
//   Q = sum over images k, l of 0.9^|k-l| a_k b_l,
//
// of either axis, where a_k is the sum of what is left of image k's views of one half of the
// landmarks and b_l of image l's views of the other half: so nothing is multiplied with what the
// same landmark leaves. What trajectory and landmarks take up makes Q differ from zero without a
// cause (they follow the noise of all views of an image at once), and neighbours of one landmark
// alike: mean and scatter of Q are those of random signs that went through the same projection.
// Q is taken in units of the sum of squares, so that the size of the noise does not matter.

/// Q over the sum of squares of each camera, without a cause.
struct NullCorrelation {
  Eigen::ArrayXd mean;
  Eigen::ArrayXd sigma;
};
/// Of the projection where the system was linearised; it hardly changes with the sizes of causes.
/// Linear in the number of views.
[[nodiscard]] NullCorrelation null_correlation(const ViewSystem& system, const ViewData& data);

/// Of each camera the probability that errors which do not go together leave as large a Q as the
/// views do where the system was linearised.
[[nodiscard]] std::vector<double> image_whiteness(const ViewSystem& system,
                                                  const ViewData& data,
                                                  const NullCorrelation& null);

}  // namespace roadbook
