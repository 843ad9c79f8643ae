#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Strict reading of numbers and names: refuses what std::stod accepts (hex, "12abc", "nan").

/// The whole of `text` (blanks at both ends allowed) as a finite decimal number; empty if it is not
/// one.
[[nodiscard]] std::optional<double> parse_double(std::string_view text);
/// The whole of `text` as a 64-bit integer; empty if it is not one. Nanosecond stamps do not fit a
/// double.
[[nodiscard]] std::optional<std::int64_t> parse_int(std::string_view text);

[[nodiscard]] std::string_view trim(std::string_view text);
/// Fields of a comma-separated line, blanks trimmed. Quotes have no meaning, as in the drive
/// format.
[[nodiscard]] std::vector<std::string_view> split(std::string_view line, char separator = ',');

/// Levenshtein distance.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);
/// The candidate nearest to `name` by edit distance, for "did you mean"; empty if all are too far
/// for a typing error.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view name,
                                                      const std::vector<std::string>& candidates);

}  // namespace roadbook
