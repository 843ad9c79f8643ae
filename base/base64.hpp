#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace roadbook {

/// Bytes as text of 64 digits (RFC 4648, section 4: padded, no line breaks).
[[nodiscard]] std::string to_base64(std::string_view bytes);
/// Empty where the text is not base64.
[[nodiscard]] std::optional<std::string> from_base64(std::string_view text);

}  // namespace roadbook
