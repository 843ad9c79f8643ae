#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/candidate.hpp"

namespace roadbook {

// The grammar: every hook times every covariate, as a smooth function of a few terms.

struct GrammarTerm {
  std::string hook;
  std::string covariate;
};

/// "wheels0.scale", "steering0.angle", "poses.across", ... that the drive has streams for.
[[nodiscard]] std::vector<std::string> grammar_hooks(const Observations& obs);
/// "constant", "speed", "yaw rate", ...
[[nodiscard]] std::vector<std::string> grammar_covariates(std::string_view hook);
/// Typical size of a term at the hook, in the hook's unit, for a covariate of unit variance.
[[nodiscard]] double grammar_tau(std::string_view hook);
[[nodiscard]] std::string_view grammar_unit(std::string_view hook);

/// Changes of all rows by the terms of hook x covariate, covariates scaled to unit variance; empty
/// where the covariate is constant on this drive.
[[nodiscard]] Columns grammar_columns(const Observations& obs,
                                      const MotionPoint& smooth_point,
                                      const GrammarTerm& term);

}  // namespace roadbook
