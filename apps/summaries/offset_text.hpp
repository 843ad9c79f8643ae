#pragma once

#include <optional>
#include <string>

#include "mapping/pipeline/truth_error.hpp"

namespace roadbook {

/// Returns the offset of a session for people: "0.012 m, 0.03 deg", or "-" if it is unknown.
[[nodiscard]] std::string offset_text(const std::optional<SessionOffset>& offset);

}  // namespace roadbook
