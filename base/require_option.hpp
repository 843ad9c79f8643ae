#pragma once

#include <string>

#include "base/error.hpp"

namespace roadbook {

/// Throws InvalidOption, naming field, value and range, unless `good`.
inline void require_option(bool good, const std::string& field, double got, const char* want) {
  if (!good) throw InvalidOption(field, std::to_string(got), want);
}

}  // namespace roadbook
