#pragma once

#include <cstddef>

#include "base/random.hpp"

namespace roadbook {

// Random signs that ride along with the rows of a pass (Hutchinson's estimator): the share of a
// row's noise that the fit leaves over is 1 minus sign times fitted sign, in the mean.

enum class Probe : std::size_t { kRow, kReading, kWalk, kKnot };

/// +1 or -1, the same for the same arguments; k < 64.
[[nodiscard]] inline double probe_sign(Probe kind, std::size_t index, std::size_t k) {
  Random random(static_cast<std::uint64_t>(kind) + 4 * index);
  return ((random() >> k) & 1U) != 0 ? 1.0 : -1.0;
}

}  // namespace roadbook
