#include "diagnosis/inference/shortlist.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace roadbook {
namespace {

// True if a catalogued effect explains nearly all that the generic effect explains; the catalogued
// effect is then preferred. The next round finds any remainder.
bool has_a_name(const std::vector<Shortlisted>& all,
                const ScoreTable& table,
                const Shortlisted& term) {
  const double enough = statistic_to_explain_term(term.score, table);
  return std::any_of(all.begin(), all.end(), [&](const Shortlisted& n) {
    const Candidate& c = table.candidates()[n.candidate];
    return c.kind == CandidateKind::kNamed && is_possible(c, n.score.size[0]) &&
           n.score.statistic >= enough;
  });
}

constexpr double kHalfChi95 = 1.92;  // [nats] that a 95 % interval reaches below the best

std::vector<std::size_t> sides_from(std::size_t first, std::size_t count) {
  std::vector<std::size_t> sides(count);
  std::iota(sides.begin(), sides.end(), first);
  return sides;
}

std::vector<std::size_t> candidate_sides(const Candidate& c) {
  std::vector<std::size_t> sides;
  for (const std::size_t column : c.columns) sides.push_back(1 + column);
  return sides;
}

// Empty for a cause that is not a place, and for a cause whose own fit searches for the best place.
std::vector<Candidate> variants_of(const CauseProblem& problem,
                                   const CauseModel& model,
                                   std::size_t a) {
  const Candidate& place = model.accepted[a].candidate;
  if (place.kind != CandidateKind::kPlace) return {};
  std::vector<Candidate> near = problem.refinements(model, place);
  if (near.size() < 2) near.clear();
  return near;
}

}  // namespace

double chance_lead_of_term(double freedom, const ScoreTable& table) {
  const auto& all = table.candidates();
  const auto terms = static_cast<double>(std::count_if(
      all.begin(), all.end(), [](const auto& c) { return c.kind == CandidateKind::kGrammar; }));
  return 3.0 + freedom + std::log(std::max(1.0, terms));
}

double statistic_to_explain_term(const Score& term, const ScoreTable& table) {
  const double chance = 2.0 * chance_lead_of_term(term.freedom, table);
  return term.statistic - std::max(chance, 0.02 * term.statistic);
}

std::vector<Shortlisted> shortlist_candidates(const ScoreTable& table, std::size_t count) {
  std::vector<Shortlisted> all;
  for (std::size_t c = 0; c < table.candidates().size(); ++c) all.push_back({c, table.score(c)});
  std::stable_sort(all.begin(), all.end(), [](const Shortlisted& a, const Shortlisted& b) {
    return a.score.evidence > b.score.evidence;
  });
  std::vector<Shortlisted> best;
  bool named = false;
  for (const Shortlisted& n : all) {
    const Candidate& c = table.candidates()[n.candidate];
    // The last is kept for a name: far from the data its score is less than a refit makes of it.
    if (count > 1 && best.size() + 1 == count && !named && c.kind != CandidateKind::kNamed)
      continue;
    const bool known = std::any_of(best.begin(), best.end(), [&](const Shortlisted& b) {
      return table.candidates()[b.candidate].name == c.name;
    });
    if (!is_possible(c, n.score.size[0])) continue;
    if (n.score.statistic < c.least_statistic) continue;
    if (known || (c.kind == CandidateKind::kGrammar && has_a_name(all, table, n))) continue;
    named = named || c.kind == CandidateKind::kNamed;
    best.push_back(n);
    if (best.size() == count) break;
  }
  return best;
}

std::optional<Shortlisted> impossible_candidate(const ScoreTable& table) {
  std::optional<Shortlisted> best;
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Shortlisted n{c, table.score(c)};
    if (!best || n.score.evidence > best->score.evidence) best = n;
  }
  if (!best) return best;
  const Candidate& c = table.candidates()[best->candidate];
  if (is_possible(c, best->score.size[0])) return {};
  return best;
}

Candidate refined_place(const CauseProblem& problem,
                        const CauseModel& model,
                        const Candidate& place) {
  std::vector<Candidate> near = problem.refinements(model, place);
  if (near.empty()) return place;
  const ScoreTable around(model, problem.project(model, std::move(near)));
  std::size_t best = 0;
  double most = -1e300;
  for (std::size_t c = 0; c < around.candidates().size(); ++c)
    if (const double t = around.score(c).statistic; t > most) {
      most = t;
      best = c;
    }
  return around.candidates()[best];
}

void settle_place(const CauseProblem& problem, CauseModel& model, std::size_t a) {
  constexpr int kRounds = 3;
  constexpr double kBetter = 0.5;  // [nats]
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Candidate> near = variants_of(problem, model, a);
    if (near.empty()) return;
    const ScoreTable around(model, problem.project(model, std::move(near)));
    CauseModel moved = model;
    const double enough = around.loss_without(a) + kBetter;
    double best = enough;
    for (std::size_t c = 0; c < around.candidates().size(); ++c) {
      const Score s = around.score_without(c, a);
      if (0.5 * s.statistic <= best) continue;
      best = 0.5 * s.statistic;
      moved.accepted[a] = {around.candidates()[c], s.size};
    }
    if (best <= enough) return;
    problem.fit(moved, 3);
    if (moved.log_likelihood < model.log_likelihood + kBetter) return;
    model = std::move(moved);
  }
}

double profile_sigma(const CauseProblem& problem, const CauseModel& model, std::size_t a) {
  std::vector<Candidate> near = variants_of(problem, model, a);
  if (near.empty()) return 0.0;
  const ScoreTable around(model, problem.project(model, std::move(near)));
  const double best = around.loss_without(a);
  const double size = model.accepted[a].size[0];
  double farthest = 0.0;
  for (std::size_t c = 0; c < around.candidates().size(); ++c) {
    const Score s = around.score_without(c, a);
    // Of this variant's sizes those that half a chi-squared of one degree allows.
    const double left = kHalfChi95 - (best - 0.5 * s.statistic);
    if (left < 0.0 || !(s.information(0, 0) > 0.0)) continue;
    const double reach = std::sqrt(2.0 * left / s.information(0, 0));
    farthest = std::max(farthest, std::abs(s.size[0] - size) + reach);
  }
  return farthest / std::sqrt(2.0 * kHalfChi95);
}

HeldOutGain gain_of_candidate(const ScoreTable& table, std::size_t c) {
  const Candidate& candidate = table.candidates()[c];
  return held_out_gain(table.innovations(), sides_from(1, table.accepted_columns()),
                       candidate_sides(candidate), {1.0}, is_local(candidate));
}

HeldOutGain gain_of_accepted(const ScoreTable& table, const CauseModel& model, std::size_t a) {
  const auto [first, count] = table.accepted_range(a);
  std::vector<std::size_t> common;
  for (std::size_t i = 0; i < table.accepted_columns(); ++i)
    if (i < first || i >= first + count) common.push_back(1 + i);
  std::vector<double> weights(1 + table.accepted_columns(), 0.0);
  weights[0] = 1.0;
  for (std::size_t i = 0; i < count; ++i)
    weights[1 + first + i] = model.accepted[a].size[static_cast<Eigen::Index>(i)];
  return held_out_gain(table.innovations(), common, sides_from(1 + first, count), weights,
                       is_local(model.accepted[a].candidate));
}

HeldOutGain gain_against_refit(const CauseProblem& problem,
                               const ScoreTable& table,
                               const CauseModel& model,
                               std::size_t a) {
  CauseModel without = problem.nominal();
  if (model.accepted.size() > 1) {
    without = model;
    drop(without, a);
    problem.fit(without, 10);
  }
  const Projection there = problem.project(without, {});
  // A changed time offset can add or remove readings at the ends of the drive.
  const Innovations before = rows_in_both(there.innovations, table.innovations());
  const Innovations after = rows_in_both(table.innovations(), there.innovations);
  const HeldOutGain gain = held_out_gain({before, sides_from(1, there.accepted)},
                                         {after, sides_from(1, table.accepted_columns())},
                                         is_local(model.accepted[a].candidate));
  return std::isfinite(gain.total) ? gain : gain_of_accepted(table, model, a);
}

bool convincing(const HeldOutGain& gain, double corrected_p) {
  return gain.total > 0.0 && (gain.low > 0.0 || gain.positive_blocks >= 0.8 || corrected_p < 1e-6);
}

}  // namespace roadbook
