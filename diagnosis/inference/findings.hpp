#pragma once

#include <span>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/inference/diagnosis_result.hpp"
#include "diagnosis/inference/search_result.hpp"

namespace roadbook {

// Searches problems for effects and turns the result into a `Diagnosis`.

/// Held-out gain of a size of `z` standard errors, of large samples: z^2 / 2 less what fitting it
/// costs, and it scatters by z.
[[nodiscard]] HeldOutGain gain_of_large_samples(double z);

/// A cause in the noise, as reports say it, with the gain of large samples.
[[nodiscard]] FoundCause found_noise(const NoiseCause& cause);

/// Searches one problem.
[[nodiscard]] Diagnosis diagnose(const CauseProblem& problem, const SearchOptions& options = {});

/// Joins several diagnoses of one drive: strongest evidence first, noise last. An effect that
/// several report appears once, with the tightest interval, and a note gives the other sizes. Each
/// place of an effect is separate. Not observable are effects that no diagnosis can show.
[[nodiscard]] Diagnosis merged(std::span<const Diagnosis> parts);

/// Searches several problems independently and joins their results.
[[nodiscard]] Diagnosis diagnose(std::span<const CauseProblem* const> problems,
                                 const SearchOptions& options = {});

}  // namespace roadbook
