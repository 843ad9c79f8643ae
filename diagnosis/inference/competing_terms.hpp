#pragma once

#include <optional>
#include <vector>

#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/inference/search_result.hpp"

namespace roadbook {

/// A generic effect that alone explains nearly what one or several accepted catalogued effects
/// explain, and that no catalogued effect corresponds to. A cause outside of the catalogue can look
/// like a combination of catalogued effects.
struct CompetingTerm {
  std::vector<std::size_t> names;  ///< accepted causes that it would replace
  Candidate term;
  double lead = 0.0;  ///< [nats] evidence of the term less that of the names, model linear
};

/// Generic effects worth a refit, best first. Those whose mean is one of the catalogued effects do
/// not compete with it: their further columns are tested separately (`lack_of_fit_warnings`).
[[nodiscard]] std::vector<CompetingTerm> competing_terms(const CauseModel& model,
                                                         const ScoreTable& table,
                                                         double replacement_lead);

struct GenericReplacement {
  std::optional<CauseModel>
      model;  ///< refitted with a term in the place of names, if that is better
  std::vector<FitWarning> doubts;  ///< names that a term would do as well for
};

/// Covariates with which an accepted term of the grammar would explain as much but
/// `replacement_lead` [nats], or but 2 % of it, where it or they are columns of the log. Order of
/// the table.
[[nodiscard]] std::vector<std::size_t> like_covariates(const CauseModel& model,
                                                       const ScoreTable& table,
                                                       std::size_t a,
                                                       double replacement_lead);

/// Replaces catalogued effects by a generic effect if its refitted evidence leads by more than
/// `replacement_lead` [nats] and residuals are white. (The more columns a generic effect has, the
/// more unmodelled error it absorbs.) If the lead is within that limit, a lack-of-fit warning is
/// raised. A generic effect of a logged column is replaced by one of a covariate of the car's
/// motion that explains the same, because a column may be a function of time or speed.
[[nodiscard]] GenericReplacement replace_by_generic_term(const CauseProblem& problem,
                                                         const CauseModel& model,
                                                         const ScoreTable& table,
                                                         double replacement_lead);

}  // namespace roadbook
