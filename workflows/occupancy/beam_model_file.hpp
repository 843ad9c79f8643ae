#pragma once

#include <filesystem>
#include <string>

#include "sensors/range/range_mixture.hpp"

namespace roadbook {

/// Reads a beam model from YAML: `short`, `maximum`, `crosstalk` (shares), `sigma_m`, `wide` (share
/// of the hits with four times the noise), `short_rate_per_m`. Missing keys are zero, 0.02 m and
/// 0.5 1/m. Throws BadInput, with file and key, for other keys and for shares that are negative or
/// whose sum is above 1.
[[nodiscard]] RangeMixture read_beam_model(const std::filesystem::path& file);

/// The same as text.
[[nodiscard]] std::string beam_model_text(const RangeMixture& mixture);

}  // namespace roadbook
