#pragma once

#include <chrono>
#include <cstdint>

namespace roadbook {

/// Nanoseconds since 1970 by the machine's clock: when somebody did something, never what a result
/// depends on.
[[nodiscard]] inline std::int64_t wall_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace roadbook
