#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace roadbook {

/// Returns the number of characters (code points) of a text in UTF-8. Empty if the text is not
/// valid UTF-8 (RFC 3629): wrong bytes, overlong forms, surrogates, or beyond U+10FFFF.
[[nodiscard]] std::optional<std::size_t> utf8_characters(std::string_view text);

}  // namespace roadbook
