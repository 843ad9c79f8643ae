#include "diagnosis/inference/acceptance.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/inference/cause_evidence.hpp"

namespace roadbook {
namespace {

// Least evidence [nats] of a catalogued effect that is tested against catalogued effects alone.
// Effects smaller than real ones have less, even if they are significant.
constexpr double kLeastOfNames = 1.0;

// Correlated residuals inflate T; the scatter of one-second blocks does not know of that. A cause
// at one place lives in one or two blocks and has no such scatter.
bool survives_blocks(const ScoreTable& table, const Shortlisted& n) {
  constexpr double kMostRobust = 1e-3;
  return chi_squared_tail(table.robust_statistic(n.candidate), n.score.freedom) <= kMostRobust;
}

}  // namespace

bool Acceptance::by_names_alone(const ScoreTable& table, const Candidate& candidate) const {
  return candidate.kind == CandidateKind::kNamed && problem_.level_of_names() > 0.0 &&
         is_white(table, problem_.channels());
}

bool Acceptance::admits_strictly(const ScoreTable& table, const Shortlisted& n) const {
  const Candidate& c = table.candidates()[n.candidate];
  const double places = c.kind == CandidateKind::kPlace ? std::exp(c.penalty) : 1.0;
  const double p = n.score.p * table.tests() * places;
  if (p > options_.max_p || n.score.evidence < options_.min_evidence) return false;
  if (!is_local(c) && !survives_blocks(table, n)) return false;
  return convincing(gain_of_candidate(table, n.candidate), p);
}

bool Acceptance::admits(const ScoreTable& table, const Shortlisted& n) const {
  if (admits_strictly(table, n)) return true;
  const Candidate& c = table.candidates()[n.candidate];
  return n.score.evidence > kLeastOfNames &&
         n.score.p * table.names() <= problem_.level_of_names() && by_names_alone(table, c) &&
         survives_blocks(table, n) && gain_of_candidate(table, n.candidate).total > 0.0;
}

double Acceptance::least_evidence(const ScoreTable& table, const Candidate& candidate) const {
  return by_names_alone(table, candidate) ? kLeastOfNames : options_.min_evidence;
}

double Acceptance::surplus(const CauseModel& model, const ScoreTable& table, std::size_t a) const {
  // What gains nothing goes first, the weakest before the others.
  constexpr double kNothing = 1e12;
  const Candidate& c = model.accepted[a].candidate;
  const bool white = !options_.doubt_correlated || is_white(table, problem_.channels());
  const double p = corrected_p_value(model, table, a);
  const HeldOutGain gain = gain_of_accepted(table, model, a);
  const bool by_names = by_names_alone(table, c);
  const bool gains = convincing(gain, white ? p : 1.0) ||
                     (by_names && gain.total > 0.0 &&
                      p * table.names() <= problem_.level_of_names() * table.tests());
  const bool told = 2.0 * table.loss_without(a) >= c.least_statistic;
  return evidence_of(model, table, a) - least_evidence(table, c) - (gains && told ? 0.0 : kNothing);
}

}  // namespace roadbook
