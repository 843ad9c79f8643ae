#pragma once

#include <string>
#include <vector>

#include "mapping/map.hpp"
#include "mapping/sessions/session_value.hpp"

namespace roadbook {

/// Shows what each session takes off the standard deviations of the others. Empty without values.
[[nodiscard]] std::string value_table(const Map& map, const std::vector<SessionValue>& values);

}  // namespace roadbook
