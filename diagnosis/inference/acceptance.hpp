#pragma once

#include <cstddef>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/inference/search_result.hpp"
#include "diagnosis/inference/shortlist.hpp"

namespace roadbook {

// Conditions for an effect to be accepted and to stay.
// The strict rule holds for generic and catalogued effects: a Bayes factor of 20 against all
// candidates together, and a significant held-out gain. Catalogued effects are few, and below six
// standard errors the scatter of held-out gains exceeds the gains. So where residuals are white and
// the problem states a level (`CauseProblem::level_of_names`), a catalogued effect is tested
// against the catalogued effects alone.
class Acceptance {
 public:
  Acceptance(const CauseProblem& problem, const SearchOptions& options)
      : problem_(problem), options_(options) {}

  /// Whether a nominee is worth a refit.
  [[nodiscard]] bool admits(const ScoreTable& table, const Shortlisted& nominee) const;
  /// Evidence [nats] that a candidate needs once it is refitted.
  [[nodiscard]] double least_evidence(const ScoreTable& table, const Candidate& candidate) const;
  /// By how much accepted cause `a` has more evidence than it needs to stay; far below 0 where it
  /// gains nothing on held-out blocks.
  [[nodiscard]] double surplus(const CauseModel& model,
                               const ScoreTable& table,
                               std::size_t a) const;

 private:
  [[nodiscard]] bool admits_strictly(const ScoreTable& table, const Shortlisted& nominee) const;
  [[nodiscard]] bool by_names_alone(const ScoreTable& table, const Candidate& candidate) const;

  const CauseProblem& problem_;
  const SearchOptions& options_;
};

}  // namespace roadbook
