#pragma once

#include <string>

#include "diagnosis/inference/diagnosis_result.hpp"

namespace roadbook {

/// If a size exceeds the plausible size by this factor, the named effect is not the cause, or not
/// the only cause.
inline constexpr double kFarBeyondPlausible = 5.0;

/// Remark on an effect of such a size; empty if its size is plausible or no plausible size is
/// declared.
[[nodiscard]] std::string size_doubt(const FoundCause& cause);

/// The mistake in a file that makes a relative size so large, as a question: "sign reversed?",
/// "degrees taken for radians?". Empty if no usual mistake has this size (within 4 %).
[[nodiscard]] std::string likely_mistake(const std::string& effect, double size);

}  // namespace roadbook
