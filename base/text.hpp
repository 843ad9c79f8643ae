#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Reading numbers and names strictly: what std::stod lets through (hex, "12abc", "nan") is refused.

/// The whole of `text` (blanks at both ends allowed) as a finite decimal number.
[[nodiscard]] std::optional<double> parse_double(std::string_view text);
/// The whole of `text` as a 64-bit integer. Nanosecond stamps do not fit a double.
[[nodiscard]] std::optional<std::int64_t> parse_int(std::string_view text);

[[nodiscard]] std::string_view trim(std::string_view text);
/// Fields of a comma-separated line, blanks trimmed. Quotes have no meaning, as in the drive
/// format.
[[nodiscard]] std::vector<std::string_view> split(std::string_view line, char separator = ',');

/// Levenshtein distance.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);
/// The candidate nearest to `name`, if near enough to be a slip of the fingers ("did you mean").
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view name,
                                                      const std::vector<std::string>& candidates);

}  // namespace roadbook
