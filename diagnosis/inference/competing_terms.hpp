#pragma once

#include <optional>
#include <vector>

#include "diagnosis/inference/lack_of_fit.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {

/// A term of the grammar that alone says about what accepted names say, one or several together,
/// and that no listed name stands for: what the catalogue lacks can look like names that it holds.
struct CompetingTerm {
  std::vector<std::size_t> names;  ///< accepted causes that it would replace
  Candidate term;
  double lead = 0.0;  ///< [nats] evidence of the term less that of the names, model linear
};

/// Those worth a refit, best first. Terms whose mean is one of the names do not compete with it:
/// what they say beside it is a test of its own (`lack_of_fit_warnings`).
[[nodiscard]] std::vector<CompetingTerm> competing_terms(const CauseModel& model,
                                                         const ScoreTable& table,
                                                         double inseparable);

struct GenericReplacement {
  std::optional<CauseModel>
      model;  ///< refitted with a term in the place of names, if that is better
  std::vector<FitWarning> doubts;  ///< names that a term would do as well for
};

/// Covariates with which an accepted term of the grammar would explain as much but `inseparable`
/// [nats], or but 2 % of it, where it or they are columns of the log. Order of the table.
[[nodiscard]] std::vector<std::size_t> like_covariates(const CauseModel& model,
                                                       const ScoreTable& table,
                                                       std::size_t a,
                                                       double inseparable);

/// A term that depends on a column of the log gives way to one that depends on what the car does
/// (the grammar's own covariates) wherever that says the same, refitted: a column may be a function
/// of time or speed. A term takes the place of its names where, refitted, its evidence leads theirs
/// by more than `inseparable` [nats] and residuals are white: the more freedom it has, the more a
/// term fits of what no model explains. Where it comes that near, the names are doubtful.
[[nodiscard]] GenericReplacement replace_by_generic_term(const CauseProblem& problem,
                                                         const CauseModel& model,
                                                         const ScoreTable& table,
                                                         double inseparable);

}  // namespace roadbook
