#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/inference/held_out.hpp"
#include "diagnosis/inference/lack_of_fit.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {

// Which causes the data want: greedy by evidence, each nominee refitted in full.

struct SearchOptions {
  double max_p = 0.01;        ///< after correction for the number of candidates
  double min_evidence = 3.0;  ///< [nats]: odds of twenty
  double inseparable = 3.0;   ///< [nats] by which one answer has to lead to replace another
  double in_set = 5.0;        ///< [nats] that a name in the set of another may lose
  std::size_t nominees = 3;   ///< refitted each round
  std::size_t max_causes = 6;
  /// Whether correlated residuals make probabilities of independent rows doubtful; not where noise
  /// is a mere guess.
  bool doubt_correlated = true;
  /// Names found that give their place to another in the end, as other data want it.
  std::map<std::string, std::string> instead;
  Progress progress;  ///< asked before each fit whether to go on
};

/// An accepted cause, judged in the final model.
struct Verdict {
  Accepted cause;
  double sigma = 0.0;  ///< of a single size
  double p = 1.0;      ///< corrected
  double statistic = 0.0;
  double evidence = 0.0;
  HeldOutGain gain;
  std::vector<std::string> covariates;   ///< of a term of the grammar: those that fit as well
  std::vector<std::string> inseparable;  ///< names that would do almost as well
  std::vector<double> instead;           ///< size of each in the cause's place
};

/// What looks like a named cause but would need a size that is physically impossible.
struct Impossible {
  Candidate candidate;
  double size = 0.0;
};

struct SearchResult {
  CauseModel model;
  std::vector<Doubt> doubts;  ///< about names in the verdicts
  std::vector<Impossible> impossible;
  std::vector<Verdict> verdicts;        ///< strongest first
  std::vector<std::string> looked_for;  ///< named candidates
  std::vector<std::string> not_observable;
};

[[nodiscard]] SearchResult search_causes(const CauseProblem& problem,
                                         const SearchOptions& options = {});

}  // namespace roadbook
