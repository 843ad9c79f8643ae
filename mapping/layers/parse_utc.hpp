#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace roadbook {

/// Nanoseconds since 1970 of a date and time by RFC 3339, such as "2024-05-17T08:30:00Z",
/// "2024-05-17T08:30:00.25Z" or "2024-05-17T10:30:00+02:00". Empty for other text, a date that the
/// calendar does not have, and years outside 1970 to 2261. A time without a zone is other text.
[[nodiscard]] std::optional<std::int64_t> parse_utc(std::string_view text);

}  // namespace roadbook
