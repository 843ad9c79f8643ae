#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>

namespace roadbook::test {

/// Hidden effects of one drive: sizes by name, noise effects included.
using Secret = std::map<std::string, double>;

inline double of(const Secret& secret, const std::string& name) {
  const auto found = secret.find(name);
  return found == secret.end() ? 0.0 : found->second;
}

/// Hidden drives begin at this time [ns].
inline constexpr std::int64_t kHiddenStart = 1'500'000'000'000'000'000LL;

/// Stamp [ns] at time `t_s` of a clock with the relative rate error `drift`.
inline std::int64_t stamp(double t_s, double drift = 0.0) {
  return kHiddenStart + static_cast<std::int64_t>(std::llround(t_s * (1.0 + drift) * 1e9));
}

}  // namespace roadbook::test
