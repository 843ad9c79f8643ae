#pragma once

#include <string>

#include "mapping/map.hpp"

namespace roadbook {

/// "3.14": with so many decimals, whatever the locale; "-" for what is not finite.
[[nodiscard]] std::string fixed(double value, int decimals);

/// `wheels`, `camera_height` or `free`.
[[nodiscard]] const char* scale_source_name(ScaleSource source);

}  // namespace roadbook
