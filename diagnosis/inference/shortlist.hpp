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

/// The best candidates by evidence, each name once and at least one name among them; terms of the
/// grammar that a name explains are left out, and so are names that would need an impossible size.
[[nodiscard]] std::vector<Shortlisted> shortlist_candidates(const ScoreTable& table,
                                                            std::size_t count);

/// [nats] by which a term of the grammar with so many columns may lead a right name by chance. It
/// is the best of all that were tried: some term that has the name as its mean fits the noise as
/// well. (Twice 12 nats of three further columns, once in 160 x 60,000.)
[[nodiscard]] double chance_lead_of_term(double freedom, const ScoreTable& table);
/// Statistic that a name must reach to explain a term of the grammar.
[[nodiscard]] double statistic_to_explain_term(const Score& term, const ScoreTable& table);

/// The best of all, if it needs a size that is physically impossible.
[[nodiscard]] std::optional<Shortlisted> impossible_candidate(const ScoreTable& table);

/// The variant of a place that fits best.
[[nodiscard]] Candidate refined_place(const CauseProblem& problem,
                                      const CauseModel& model,
                                      const Candidate& place);

/// Moves accepted place `a` to the variant that fits best beside the other causes, refitted, as
/// long as that helps: a fit alone ends on the nearest hill.
void settle_place(const CauseProblem& problem, CauseModel& model, std::size_t a);
/// Standard error of accepted place `a`'s size by the profile of the likelihood over its variants;
/// 0 of what has none.
[[nodiscard]] double profile_sigma(const CauseProblem& problem,
                                   const CauseModel& model,
                                   std::size_t a);

/// Held-out gain of adding candidate c to the accepted causes.
[[nodiscard]] HeldOutGain gain_of_candidate(const ScoreTable& table, std::size_t c);
/// Held-out gain of accepted cause a, given the other accepted causes.
[[nodiscard]] HeldOutGain gain_of_accepted(const ScoreTable& table,
                                           const CauseModel& model,
                                           std::size_t a);
/// The same against the model without it, fitted anew: where readings bend with a size, the
/// straight line back to 0 ends elsewhere (a drift of clocks gains a quarter more than along it).
[[nodiscard]] HeldOutGain gain_against_refit(const CauseProblem& problem,
                                             const ScoreTable& table,
                                             const CauseModel& model,
                                             std::size_t a);
/// Held-out gain that counts as one: surely above 0, or in nearly all blocks, or of a cause that is
/// beyond doubt.
[[nodiscard]] bool convincing(const HeldOutGain& gain, double corrected_p);

}  // namespace roadbook
