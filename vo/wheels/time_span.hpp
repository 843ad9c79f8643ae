#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace roadbook {

using TimeSpan = std::pair<std::int64_t, std::int64_t>;  ///< first and last time [ns]

/// Adds the motion between two keyframes to times that ascend by their beginning. A fault begins
/// and ends up to 0.15 s before and after the keyframes that show it. Times less than half a second
/// apart become one.
void add_span(std::vector<TimeSpan>& spans, std::int64_t from_ns, std::int64_t to_ns);

/// Both sets of times as one: ascending, apart from each other.
[[nodiscard]] std::vector<TimeSpan> united(std::vector<TimeSpan> a, const std::vector<TimeSpan>& b);

/// Those of `spans` that overlap none of `known`.
[[nodiscard]] std::vector<TimeSpan> without(std::vector<TimeSpan> spans,
                                            const std::vector<TimeSpan>& known);

}  // namespace roadbook
