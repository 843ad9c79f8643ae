#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>

#include "drive/problem_list.hpp"

namespace roadbook {

/// First and last stamp of a stream.
struct StampSpan {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = -1;

  void add(std::int64_t t_ns) {
    first_ns = std::min(first_ns, t_ns);
    last_ns = std::max(last_ns, t_ns);
  }
  [[nodiscard]] bool known() const { return first_ns <= last_ns; }
  [[nodiscard]] bool meets(const StampSpan& other) const {
    return first_ns <= other.last_ns && other.first_ns <= last_ns;
  }
  /// Leaves out the time in which sensors start and stop.
  [[nodiscard]] bool covers(const StampSpan& other) const {
    constexpr std::int64_t kSlackNs = 1'000'000'000;
    return first_ns - other.first_ns <= kSlackNs && other.last_ns - last_ns <= kSlackNs;
  }
};

/// Wheels of another clock or unit would give wrong results without any message: an error. Wheels
/// that cover the images in part, or a truth that does not overlap them, deserve a warning.
void check_spans(const std::filesystem::path& sensors,
                 std::span<const std::int64_t> frames,
                 const StampSpan& wheels,
                 const StampSpan& truth,
                 ProblemList& problems);

}  // namespace roadbook
