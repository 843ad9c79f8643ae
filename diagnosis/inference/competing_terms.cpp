#include "diagnosis/inference/competing_terms.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "diagnosis/inference/cause_evidence.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMostRefits = 4;
constexpr std::size_t kMostNames = 3;  // that one term is asked to replace

// All sets of one to three accepted names, in a fixed order.
std::vector<std::vector<std::size_t>> sets_of_names(const CauseModel& model) {
  std::vector<std::vector<std::size_t>> sets;
  for (unsigned bits = 1; bits < (1U << model.accepted.size()); ++bits) {
    std::vector<std::size_t> set;
    bool names = true;
    for (std::size_t a = 0; a < model.accepted.size(); ++a) {
      if ((bits >> a & 1U) == 0) continue;
      set.push_back(a);
      names = names && model.accepted[a].candidate.kind == CandidateKind::kNamed;
    }
    if (names && set.size() <= kMostNames) sets.push_back(std::move(set));
  }
  return sets;
}

bool has_mean_of(const Candidate& term, const CauseModel& model) {
  return std::any_of(model.accepted.begin(), model.accepted.end(),
                     [&](const Accepted& a) { return a.candidate.name == term.named_mean; });
}

// The model with the rival in the place of its names, to be refitted.
CauseModel replaced(const CauseModel& model, const CompetingTerm& rival) {
  CauseModel other = model;
  for (auto a = rival.names.rbegin(); a != rival.names.rend(); ++a) drop(other, *a);
  accept(other, rival.term);
  return other;
}

// Whether the names are special cases of the term. The further part of the term has another test.
bool contains(const ScoreTable& table, std::size_t c, const std::vector<std::size_t>& names) {
  constexpr double kAlmostAll = 0.99;
  return table.candidates()[c].columns.size() > names.size() &&
         std::all_of(names.begin(), names.end(),
                     [&](std::size_t a) { return table.made_up(c, a) > kAlmostAll; });
}

// Evidence of a refitted model's last effect minus its gain in log likelihood: prior, columns,
// candidates.
double refitted_cost(const CauseModel& model, const Candidate& last, double tests) {
  return refitted_evidence(model, last.penalty + std::log(tests)) - 0.5 * last_statistic(model);
}

// Once a name, of its best rival.
void doubt(const std::string& name, const CompetingTerm& rival, GenericReplacement& result) {
  const bool said = std::any_of(result.doubts.begin(), result.doubts.end(),
                                [&](const FitWarning& d) { return d.name == name; });
  const Candidate& term = rival.term;
  if (!said)
    result.doubts.push_back(
        {name, "may be a generic effect instead: " + term.hook +
                   (term.covariate == "constant" ? " has a constant error"
                                                 : " depends on " + term.covariate)});
}

// What a covariate may lose that is said to explain as much: of strong causes a part, since a
// trajectory that is fitted is not the one that was driven.
double slack_of(double own, double replacement_lead) {
  constexpr double kPart = 0.02;
  return std::max(replacement_lead, kPart * own);
}

// The first accepted term of a logged column that a covariate of the grammar's own says as well.
std::optional<CauseModel> with_plainer_covariate(const CauseProblem& problem,
                                                 const CauseModel& model,
                                                 const ScoreTable& table,
                                                 double replacement_lead) {
  for (std::size_t a = 0; a < model.accepted.size(); ++a) {
    if (!model.accepted[a].candidate.logged) continue;
    const double slack = slack_of(table.loss_without(a), replacement_lead);
    std::optional<CauseModel> best;
    for (const std::size_t c : like_covariates(model, table, a, replacement_lead)) {
      if (table.candidates()[c].logged) continue;
      CauseModel other = model;
      drop(other, a);
      accept(other, table.candidates()[c]);
      problem.fit(other, 3);
      if (other.log_likelihood > (best ? best->log_likelihood : model.log_likelihood - slack))
        best = std::move(other);
    }
    if (best) return best;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::size_t> like_covariates(const CauseModel& model,
                                         const ScoreTable& table,
                                         std::size_t a,
                                         double replacement_lead) {
  std::vector<std::size_t> like;
  const Candidate& term = model.accepted[a].candidate;
  if (term.kind != CandidateKind::kGrammar) return like;
  const double own = table.loss_without(a);
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Candidate& other = table.candidates()[c];
    if (other.kind != CandidateKind::kGrammar || other.hook != term.hook ||
        other.covariate == term.covariate || !(other.logged || term.logged))
      continue;
    if (own - 0.5 * table.score_without(c, a).statistic < slack_of(own, replacement_lead))
      like.push_back(c);
  }
  return like;
}

std::vector<CompetingTerm> competing_terms(const CauseModel& model,
                                           const ScoreTable& table,
                                           double replacement_lead) {
  std::set<std::string> listed;
  for (const Candidate& c : table.candidates())
    if (c.kind == CandidateKind::kNamed) listed.insert(c.name);
  std::vector<CompetingTerm> rivals;
  for (const std::vector<std::size_t>& names : sets_of_names(model)) {
    const double evidence = evidence_of(model, table, names);
    // Scores of another linearisation are good to some hundredths of what there is to explain.
    const double slack = replacement_lead + 0.03 * table.loss_without(names);
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      const Candidate& term = table.candidates()[c];
      if (term.kind != CandidateKind::kGrammar || has_mean_of(term, model)) continue;
      if (term.covariate == "constant" && listed.contains(term.named_mean)) continue;
      if (contains(table, c, names)) continue;
      const double lead = table.score_without(c, names).evidence - evidence;
      if (lead > -slack) rivals.push_back({names, term, lead});
    }
  }
  std::stable_sort(rivals.begin(), rivals.end(),
                   [](const CompetingTerm& a, const CompetingTerm& b) { return a.lead > b.lead; });
  if (rivals.size() > kMostRefits) rivals.resize(kMostRefits);
  return rivals;
}

GenericReplacement replace_by_generic_term(const CauseProblem& problem,
                                           const CauseModel& model,
                                           const ScoreTable& table,
                                           double replacement_lead) {
  GenericReplacement result;
  result.model = with_plainer_covariate(problem, model, table, replacement_lead);
  if (result.model) return result;
  const bool white = is_white(table, problem.channels());
  for (const CompetingTerm& rival : competing_terms(model, table, replacement_lead)) {
    CauseModel other = replaced(model, rival);
    problem.fit(other, 4);
    // Both models are compared about the same linearisation. After the refit, likelihood, prior and
    // number of columns decide.
    const double explained = table.loss_without(rival.names);
    const double cost = evidence_of(model, table, rival.names) - explained;
    const double gained = other.log_likelihood - model.log_likelihood;
    const double refitted = gained + refitted_cost(other, rival.term, table.tests()) - cost;
    const double lead = std::max(rival.lead, refitted);
    // Likelihoods lack the determinant, which delays move by some nats: both have to say so.
    const bool both = rival.lead > 0.0 && refitted > 0.0;
    if (white && both && lead > replacement_lead) {
      result.model = std::move(other);
      result.doubts.clear();
      return result;
    }
    if (lead < -replacement_lead) continue;
    for (const std::size_t a : rival.names) doubt(model.accepted[a].candidate.name, rival, result);
  }
  return result;
}

}  // namespace roadbook
