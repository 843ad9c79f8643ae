#pragma once

#include <chrono>
#include <cstdint>

namespace roadbook {

/// Nanoseconds since 1970 by the machine's clock. Use: the time of a user's action. No result may
/// depend on this time.
[[nodiscard]] inline std::int64_t wall_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace roadbook
