#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/sessions/session_value.hpp"

namespace roadbook {

/// One object for each session: its value to the others. Lengths are in metres.
[[nodiscard]] nlohmann::ordered_json value_json(const Map& map,
                                                const std::vector<SessionValue>& values);

/// "monday 12.3 mm, tuesday 0.4 mm": what each session takes off the standard deviation of the
/// other sessions' poses. Empty without values.
[[nodiscard]] std::string value_text(const Map& map, const std::vector<SessionValue>& values);

/// Standard deviations without and with a session: "12.3 -> 11.2"; "-" if nothing was compared.
[[nodiscard]] std::string change_mm_text(const SigmaChange& change);

}  // namespace roadbook
