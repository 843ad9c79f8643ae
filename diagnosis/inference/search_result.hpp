#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/inference/held_out.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {

/// Log likelihood [nats] that a member of a confounded set may lose against the accepted effect.
inline constexpr double kConfoundedLoss = 5.0;

struct SearchOptions {
  double max_p = 0.01;        ///< after correction for the number of candidates
  double min_evidence = 3.0;  ///< log Bayes factor [nats] that an effect needs: 3 is a factor of 20
  /// [nats] of evidence by which a generic effect must lead a catalogued one to be preferred.
  double replacement_lead = 3.0;
  double confounded_loss = kConfoundedLoss;
  std::size_t nominees = 3;  ///< shortlisted candidates, refitted each round
  std::size_t max_causes = 6;
  /// Whether autocorrelated residuals raise a lack-of-fit warning; not where the noise model is a
  /// guess.
  bool doubt_correlated = true;
  /// Accepted effects that are replaced at the end, because other data have decided: old, new name.
  std::map<std::string, std::string> instead;
  Progress progress;  ///< called before each fit; returning false stops the search
};

/// An accepted effect, judged in the final model.
struct AcceptedEffect {
  Accepted cause;
  double sigma = 0.0;  ///< of a single size
  /// P-value, corrected for the number of candidates; where errors of the reference last, with
  /// them.
  double p = 1.0;
  double statistic = 0.0;
  double evidence = 0.0;
  HeldOutGain gain;
  std::vector<std::string> covariates;   ///< of a generic effect: those that fit as well
  std::vector<std::string> inseparable;  ///< confounded effects: they explain nearly as much
  std::vector<double> instead;           ///< size that each would have
  /// A generic effect that errors of the reference that last explain as well.
  bool of_lasting_errors = false;
};

/// A sign that an accepted effect is not the true cause, although it explains much.
struct FitWarning {
  std::string name;  ///< accepted effect
  std::string text;  ///< "its size depends on speed (p = 1e-05)"
};

/// A catalogued effect that the data favour, but with a size that is physically impossible.
struct Impossible {
  Candidate candidate;
  double size = 0.0;
};

/// A catalogued effect that this drive shows alone, but not in addition to an accepted effect.
struct HiddenEffect {
  std::string name;
  /// The accepted effect ("poses.scale depends on place"), or "errors of the reference that last".
  std::string by;
};

struct SearchResult {
  CauseModel model;
  std::vector<FitWarning> doubts;  ///< lack of fit of the final model
  std::vector<Impossible> impossible;
  std::vector<AcceptedEffect> verdicts;  ///< strongest first
  std::vector<std::string> looked_for;   ///< catalogued effects that were considered
  std::vector<std::string> not_observable;
  std::vector<HiddenEffect> hidden;
};

}  // namespace roadbook
