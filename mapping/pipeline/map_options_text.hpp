#pragma once

#include <string>

#include "mapping/pipeline/build_map.hpp"

namespace roadbook {

/// Every option that a map depends on, in words: part of the key of its inputs, and in its `meta`.
[[nodiscard]] std::string options_text(const MapOptions& options);

}  // namespace roadbook
