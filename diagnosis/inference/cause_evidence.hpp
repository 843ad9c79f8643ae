#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/search_result.hpp"

namespace roadbook {

// Evidence of the causes in a fitted model, and of candidates that are not in the model.

/// Evidence [nats] of the last cause of a refitted model against the model without it.
[[nodiscard]] double refitted_evidence(const CauseModel& model, double penalty);
/// What that cause explains, likewise: square of its size over its error.
[[nodiscard]] double last_statistic(const CauseModel& model);
/// Evidence [nats] of accepted cause `a`, with the sizes of the other causes free.
[[nodiscard]] double evidence_of(const CauseModel& model, const ScoreTable& table, std::size_t a);
/// Of several together.
[[nodiscard]] double evidence_of(const CauseModel& model,
                                 const ScoreTable& table,
                                 const std::vector<std::size_t>& causes);
/// P-value of accepted cause `a`, corrected for the number of candidates.
[[nodiscard]] double corrected_p_value(const CauseModel& model,
                                       const ScoreTable& table,
                                       std::size_t a);
/// Where residuals stay correlated, probabilities of independent rows say too much.
[[nodiscard]] bool is_white(const ScoreTable& table, const std::vector<ChannelName>& channels);
/// Negative log prior density of the sizes of all accepted effects, without its constant [nats].
[[nodiscard]] double prior_cost(const CauseModel& model);
/// Places of one name are many.
[[nodiscard]] bool is_accepted(const CauseModel& model, const Candidate& candidate);

/// Judges accepted effect `a` (index) in the final model: size's standard error, p-value, evidence,
/// held-out gain and confounded set. A catalogued effect is in the set if it loses less than
/// `confounded_loss` [nats] of log likelihood in the place of `a`. If residuals are not white
/// (`white` is false), the limit grows by the ratio of the statistic of independent rows to that of
/// independent blocks.
[[nodiscard]] AcceptedEffect judge_effect(const CauseModel& model,
                                          const ScoreTable& table,
                                          std::size_t a,
                                          double confounded_loss,
                                          bool white);
/// Adds further catalogued effects to the confounded set in `verdict`, by refits. The scores of
/// `judge_effect` are linear approximations, exact to a few hundredths of what `a` explains. So
/// each effect that would lose up to a tenth of it is refitted in the place of `a`. It joins the
/// set if it then loses less than `confounded_loss` [nats].
void add_refitted(const CauseProblem& problem,
                  const CauseModel& model,
                  const ScoreTable& table,
                  std::size_t a,
                  double confounded_loss,
                  AcceptedEffect& verdict);
/// The model with accepted cause `a` under another name, refitted. The unchanged model if no
/// candidate has the name.
[[nodiscard]] CauseModel with_other_name(const CauseProblem& problem,
                                         const CauseModel& model,
                                         const ScoreTable& table,
                                         std::size_t a,
                                         const std::string& name);
/// Adds the best nominee if it would need an impossible size and is not among them yet.
void note_impossible(const ScoreTable& table,
                     double min_evidence,
                     std::vector<Impossible>& impossible);
/// Effects that even at twice their plausible size would not have been named, whatever the model
/// already explains by other effects.
[[nodiscard]] std::vector<std::string> not_observable(const CauseModel& model,
                                                      const ScoreTable& table);
/// Effects that would have been named without one accepted effect, which explains the same changes.
[[nodiscard]] std::vector<HiddenEffect> hidden_effects(const CauseModel& model,
                                                       const ScoreTable& table);

}  // namespace roadbook
