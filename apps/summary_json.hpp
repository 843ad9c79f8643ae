#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "mapping/pipeline/build_map.hpp"

namespace roadbook {

// Results with the fixed keys of docs/design, "Machine-readable results".

[[nodiscard]] nlohmann::ordered_json to_json(const MapSummary& summary);
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<Problem>& problems);
/// Null without one.
[[nodiscard]] nlohmann::ordered_json to_json(const std::optional<SessionOffset>& offset);

}  // namespace roadbook
