#pragma once

#include <string>

#include "diagnosis/inference/findings.hpp"

namespace roadbook {

/// A size beyond so many times the plausible one is not what the name says, or not alone.
inline constexpr double kFarBeyondPlausible = 5.0;

/// What to say of a cause whose size is so far beyond: empty where it is not, or where nothing is
/// declared of the effect.
[[nodiscard]] std::string size_doubt(const FoundCause& cause);

}  // namespace roadbook
