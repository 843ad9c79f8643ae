#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnosis/inference/held_out.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {

// Selects the candidates that are worth a full refit, and computes their held-out gain.

struct Shortlisted {
  std::size_t candidate = 0;
  Score score;
};

/// The `count` candidates with the most evidence, each name once, at least one catalogued effect
/// among them. Left out are generic effects that a catalogued effect explains, and catalogued
/// effects that would need an impossible size.
[[nodiscard]] std::vector<Shortlisted> shortlist_candidates(const ScoreTable& table,
                                                            std::size_t count);

/// Log likelihood [nats] by which a generic effect with `freedom` columns may lead the true
/// catalogued effect by chance. The generic effect is the best of many: some of those whose mean is
/// the catalogued effect also fit the noise.
[[nodiscard]] double chance_lead_of_term(double freedom, const ScoreTable& table);
/// Statistic that a catalogued effect must reach to explain the generic effect with score `term`.
[[nodiscard]] double statistic_to_explain_term(const Score& term, const ScoreTable& table);

/// The candidate with the most evidence, if it needs a size that is physically impossible.
[[nodiscard]] std::optional<Shortlisted> impossible_candidate(const ScoreTable& table);

/// The variant of a place that fits best.
[[nodiscard]] Candidate refined_place(const CauseProblem& problem,
                                      const CauseModel& model,
                                      const Candidate& place);

/// Moves accepted place `a` (index) to the variant that fits best with the other effects in the
/// model, refits, and repeats as long as the likelihood grows. A fit alone ends in the nearest
/// local maximum.
void settle_place(const CauseProblem& problem, CauseModel& model, std::size_t a);
/// Standard error of the size of accepted place `a` by the profile likelihood over its variants; 0
/// if it has no variants.
[[nodiscard]] double profile_sigma(const CauseProblem& problem,
                                   const CauseModel& model,
                                   std::size_t a);

/// Held-out gain of adding candidate c to the accepted causes.
[[nodiscard]] HeldOutGain gain_of_candidate(const ScoreTable& table, std::size_t c);
/// Held-out gain of accepted cause a, given the other accepted causes.
[[nodiscard]] HeldOutGain gain_of_accepted(const ScoreTable& table,
                                           const CauseModel& model,
                                           std::size_t a);
/// The same, but against a refit of the model without the effect. Needed where readings are not
/// linear in the size, so that the linearised model at size 0 is wrong (clock drift).
[[nodiscard]] HeldOutGain gain_against_refit(const CauseProblem& problem,
                                             const ScoreTable& table,
                                             const CauseModel& model,
                                             std::size_t a);
/// True if a held-out gain is significant: its interval is above 0, or nearly all blocks gain, or
/// the gain is positive and `corrected_p` leaves no doubt.
[[nodiscard]] bool convincing(const HeldOutGain& gain, double corrected_p);

}  // namespace roadbook
