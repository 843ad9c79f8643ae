#pragma once

#include <span>

#include "vo/descriptor.hpp"

namespace roadbook {

/// Returns the index of the descriptor with the smallest sum of distances to all others; of equal
/// ones the first. It stands for a landmark that several images show: the first image that shows
/// it mostly does so from far away. `descriptors` must not be empty.
[[nodiscard]] std::size_t middle_descriptor(std::span<const Descriptor> descriptors);

}  // namespace roadbook
