#pragma once

#include <string>

#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

/// All options that a map depends on, as text. Part of the inputs key; stored in `map_meta`.
[[nodiscard]] std::string options_text(const MapOptions& options);

}  // namespace roadbook
