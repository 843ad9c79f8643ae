#pragma once

#include <filesystem>
#include <string>

#include "sensors/effects.hpp"

namespace roadbook {

// The file behind `--model` and `diagnose --write-model`: what a drive's sensors are known to do
// beyond the nominal model.
//
//     effects:
//       wheels0.radius: 0.012

/// Throws BadInput for other keys, unknown effects and sizes that are no numbers.
[[nodiscard]] EffectSizes read_effect_model(const std::filesystem::path& file);

[[nodiscard]] std::string effect_model_text(const EffectSizes& sizes);

}  // namespace roadbook
