#pragma once

#include <vector>

#include "speedmap/property_map/interpolation.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

/// Moments of the mixture of knots with given moments: m = sum I_l M_l and
/// V = sum I_l (W_l + (M_l - m)^2), which is E[y^2] - m^2 without its cancellation. `at`: moments
/// of the knots, in the order of `near`.
[[nodiscard]] PropertyMoments blend(const Interpolation& near,
                                    const std::vector<PropertyMoments>& at);
[[nodiscard]] PropertyMomentsDerivatives blend(const Interpolation& near,
                                               const InterpolationDerivatives& derivatives,
                                               const std::vector<PropertyMoments>& at);

}  // namespace roadbook
