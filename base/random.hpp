#pragma once

#include <cstdint>
#include <string_view>

namespace roadbook {

// Seeded random numbers that are the same on every machine. Engine and distributions are
// implemented here, because the distributions of the standard library differ between libraries.

/// xoshiro256** (Blackman and Vigna 2018), seeded through SplitMix64. A UniformRandomBitGenerator.
class Random {
 public:
  using result_type = std::uint64_t;

  explicit Random(std::uint64_t seed);
  /// The stream of (seed, name, index). Streams are independent: a further draw from one stream
  /// changes no other.
  Random(std::uint64_t seed, std::string_view name, std::uint64_t index = 0);

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~std::uint64_t{0}; }
  result_type operator()();

  /// Uniform in [0, 1).
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high);
  /// Standard normal (Box-Muller, both values used).
  double normal();
  double normal(double mean, double sigma) { return mean + sigma * normal(); }
  /// Uniform integer in [0, n); n > 0. Unbiased.
  std::uint64_t below(std::uint64_t n);

 private:
  std::uint64_t state_[4];
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace roadbook
