#pragma once

#include <span>

#include "vo/descriptor.hpp"

namespace roadbook {

/// Returns the index of the descriptor with the smallest sum of distances to all others; of equal
/// ones the first. It describes a landmark in several images: the first image often shows the
/// landmark from far away. `descriptors` must not be empty.
[[nodiscard]] std::size_t middle_descriptor(std::span<const Descriptor> descriptors);

}  // namespace roadbook
