#include "mapping/landmark_descriptor.hpp"

#include <vector>

namespace roadbook {

std::size_t middle_descriptor(std::span<const Descriptor> descriptors) {
  std::vector<long> sums(descriptors.size(), 0);
  for (std::size_t i = 0; i < descriptors.size(); ++i)
    for (std::size_t j = i + 1; j < descriptors.size(); ++j) {
      const int distance = hamming(descriptors[i], descriptors[j]);
      sums[i] += distance;
      sums[j] += distance;
    }
  std::size_t best = 0;
  for (std::size_t i = 1; i < sums.size(); ++i)
    if (sums[i] < sums[best]) best = i;
  return best;
}

}  // namespace roadbook
