#pragma once

#include <string>

#include "diagnosis/inference/findings.hpp"

namespace roadbook {

/// If a size exceeds the plausible size by this factor, the named effect is not the cause, or not
/// the only cause.
inline constexpr double kFarBeyondPlausible = 5.0;

/// What to say of a cause whose size is so far beyond: empty where it is not, or where nothing is
/// declared of the effect.
[[nodiscard]] std::string size_doubt(const FoundCause& cause);

}  // namespace roadbook
