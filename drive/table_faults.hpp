#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Explains in a message why a line of text is no row of the expected table. Tables of other
// programs have other separators, quotes, decimal commas and encodings.

/// "UTF-16 text" or "line ends of CR alone"; empty if neither applies.
[[nodiscard]] std::string encoding_fault(std::string_view line);

/// Names the wrong separators in a row of `got` fields where `want` are wanted ("semicolons between
/// them"), or quotes, or decimal commas. Empty where none of these is found.
[[nodiscard]] std::string layout_fault(std::string_view line,
                                       char separator,
                                       std::size_t got,
                                       std::size_t want);

/// "commas", "blanks", "semicolons", "tabs"; "'x'" for any other.
[[nodiscard]] std::string separator_name(char separator);

/// " (TEXT)", or nothing.
[[nodiscard]] std::string in_brackets(const std::string& text);

/// "a finite number"; for text with a decimal comma, the text names the comma.
[[nodiscard]] std::string number_wanted(std::string_view text);

/// Fields between runs of blanks and tabs.
[[nodiscard]] std::vector<std::string_view> split_at_blanks(std::string_view line);

}  // namespace roadbook
