#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "mapping/layers/parse_utc.hpp"

namespace roadbook {

/// The time of option `--now`, nanoseconds since 1970; empty where it is not given. Throws
/// InvalidOption.
[[nodiscard]] inline std::optional<std::int64_t> now_option(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto now_ns = parse_utc(text);
  if (!now_ns) throw InvalidOption("--now", text, "a time such as 2024-05-17T08:30:00Z");
  return now_ns;
}

}  // namespace roadbook
