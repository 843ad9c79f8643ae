#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "vo/descriptor.hpp"

namespace roadbook {

/// A descriptor near a query.
struct NearDescriptor {
  int index = 0;     ///< in the vector of descriptors
  int distance = 0;  ///< of 512 bits
};

enum class DescriptorSearchMethod {
  kExact,  ///< compares with all
  kLsh,    ///< locality-sensitive hashing of FLANN (Lv et al. 2007): misses some neighbours
};

struct DescriptorSearchOptions {
  DescriptorSearchMethod method = DescriptorSearchMethod::kLsh;
  int tables = 8;          ///< of hash keys
  int key_bits = 18;       ///< of the 512 that form one key
  int probe_level = 1;     ///< keys that differ in up to this number of bits are visited too
  std::uint64_t seed = 1;  ///< of the choice of bits

  /// Throws InvalidOption.
  void check() const;
};

/// Finds the nearest of many descriptors. Copies the descriptors. Deterministic: the bits of the
/// hash keys follow from the seed. `nearest` is not for concurrent use with kLsh.
class DescriptorSearch {
 public:
  DescriptorSearch(std::vector<Descriptor> descriptors, const DescriptorSearchOptions& options);
  ~DescriptorSearch();
  DescriptorSearch(DescriptorSearch&&) noexcept;
  DescriptorSearch& operator=(DescriptorSearch&&) noexcept;

  /// The `count` nearest of each query with at most `max_distance` bits; fewer if the search finds
  /// fewer. Nearest first, then by index.
  [[nodiscard]] std::vector<std::vector<NearDescriptor>> nearest(
      const std::vector<Descriptor>& queries, std::size_t count, int max_distance) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
