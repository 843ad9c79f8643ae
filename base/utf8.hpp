#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace roadbook {

/// Characters (code points) of a text in UTF-8. Empty where the text is not UTF-8: a byte out of
/// place, a longer form than needed, a surrogate, or beyond U+10FFFF (RFC 3629).
[[nodiscard]] std::optional<std::size_t> utf8_characters(std::string_view text);

}  // namespace roadbook
