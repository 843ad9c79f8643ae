#include "diagnosis/search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/nomination.hpp"

namespace roadbook {
namespace {

// Covariance of all sizes in the model's last fit.
Eigen::MatrixXd covariance_of(const CauseModel& model) {
  Eigen::MatrixXd F = model.information;
  F.diagonal() *= 1.0 + 1e-10;
  return F.ldlt().solve(Eigen::MatrixXd::Identity(F.rows(), F.cols()));
}

// Evidence of the last cause of a refitted model against the model without it.
double refitted_evidence(const CauseModel& model, double penalty) {
  const Eigen::MatrixXd covariance = covariance_of(model);
  const Accepted& last = model.accepted.back();
  const Eigen::Index n = last.size.size();
  const Eigen::MatrixXd information =
      covariance.bottomRightCorner(n, n).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  return log_evidence(information * last.size, information, last.candidate.tau) - penalty;
}

class Search {
 public:
  Search(const CauseProblem& problem, const SearchOptions& options)
      : problem_(problem), options_(options), model_(problem.nominal()) {}

  SearchResult run() {
    for (std::size_t round = 0; round < options_.max_causes; ++round) {
      if (!extend(table())) break;
      swap_pass();
    }
    prune();
    return conclude();
  }

 private:
  // Scores at the current model; kept until the model changes.
  const ScoreTable& table() {
    report(options_.progress, "causes", model_.accepted.size(), 0);
    if (!table_) table_.emplace(model_, problem_.project(model_, problem_.candidates(model_)));
    return *table_;
  }
  void fit(CauseModel& model, int iterations) const {
    report(options_.progress, "causes", model_.accepted.size(), 0);
    problem_.fit(model, iterations);
  }
  void become(CauseModel model) {
    model_ = std::move(model);
    table_.reset();
  }

  // The variant of a place that fits best.
  Candidate refined(const Candidate& place) const {
    std::vector<Candidate> near = problem_.refinements(model_, place);
    if (near.empty()) return place;
    const ScoreTable around(model_, problem_.project(model_, std::move(near)));
    std::size_t best = 0;
    double most = -1e300;
    for (std::size_t c = 0; c < around.candidates().size(); ++c)
      if (const double t = around.score(c).statistic; t > most) {
        most = t;
        best = c;
      }
    return around.candidates()[best];
  }

  bool passes(const ScoreTable& table, const Nominee& n) const {
    const double p = n.score.p * table.tests() *
                     std::exp(table.candidates()[n.candidate].kind == CandidateKind::kPlace
                                  ? table.candidates()[n.candidate].penalty
                                  : 0.0);
    if (p > options_.max_p || n.score.evidence < options_.min_evidence) return false;
    const Candidate& c = table.candidates()[n.candidate];
    // Correlated residuals inflate T; the scatter of one-second blocks does not know of that. A
    // cause at one place lives in one or two blocks and has no such scatter.
    if (is_local(c)) return convincing(gain_of_candidate(table, n.candidate), p);
    const double robust = chi_squared_tail(table.robust_statistic(n.candidate), n.score.freedom);
    if (robust > 1e-3) return false;
    return convincing(gain_of_candidate(table, n.candidate), p);
  }

  bool extend(const ScoreTable& table) {
    std::vector<CauseModel> refits;
    double best = -1e300;
    std::size_t best_at = 0;
    note_impossible(table);
    for (const Nominee& n : nominate(table, options_.nominees)) {
      // A refit changes a score, but it does not double it.
      if (!passes(table, n) || n.score.evidence < 0.5 * best) continue;
      Candidate c = table.candidates()[n.candidate];
      if (c.kind == CandidateKind::kPlace) c = refined(c);
      CauseModel model = model_;
      accept(model, c);
      fit(model, 3);
      if (!(model.log_likelihood > model_.log_likelihood)) continue;
      if (c.kind != CandidateKind::kGrammar && !is_possible(c, model.accepted.back().size[0]))
        continue;
      const double evidence = refitted_evidence(model, c.penalty + std::log(table.tests()));
      refits.push_back(std::move(model));
      // A name that explains the data about as well as a term of the grammar is the better answer.
      const double handicap = c.kind == CandidateKind::kGrammar ? options_.inseparable : 0.0;
      if (evidence - handicap > best) {
        best = evidence - handicap;
        best_at = refits.size() - 1;
      }
    }
    if (best < options_.min_evidence) return false;
    become(std::move(refits[best_at]));
    return true;
  }

  // An earlier name may now lose to another.
  void swap_pass() {
    for (std::size_t a = 0; a + 1 < model_.accepted.size(); ++a) {
      const ScoreTable& table = this->table();
      const double own = evidence_of(table, a);
      double best = own + 1.0;
      std::size_t best_at = table.candidates().size();
      for (std::size_t c = 0; c < table.candidates().size(); ++c) {
        if (is_accepted(table.candidates()[c])) continue;
        const Score s = table.score_without(c, a);
        if (s.evidence > best) {
          best = s.evidence;
          best_at = c;
        }
      }
      if (best_at == table.candidates().size()) continue;
      CauseModel model = model_;
      const Candidate other = table.candidates()[best_at];
      drop(model, a);
      accept(model, other);
      fit(model, 4);
      if (refitted_evidence(model, other.penalty + std::log(table.tests())) > own + 1.0)
        become(std::move(model));
    }
  }

  [[nodiscard]] bool is_accepted(const Candidate& c) const {
    return std::any_of(model_.accepted.begin(), model_.accepted.end(), [&](const Accepted& a) {
      return a.candidate.name == c.name && c.kind != CandidateKind::kPlace;
    });
  }

  [[nodiscard]] double evidence_of(const ScoreTable& table, std::size_t a) const {
    const Eigen::MatrixXd covariance = covariance_of(model_);
    const auto [first, count] = table.accepted_range(a);
    const auto n = static_cast<Eigen::Index>(count);
    const Eigen::MatrixXd information =
        covariance.block(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(first), n, n)
            .ldlt()
            .solve(Eigen::MatrixXd::Identity(n, n));
    const Accepted& cause = model_.accepted[a];
    return log_evidence(information * cause.size, information, cause.candidate.tau) -
           cause.candidate.penalty - std::log(table.tests());
  }

  // Said once, by what the first round saw.
  void note_impossible(const ScoreTable& table) {
    const auto n = impossible_nominee(table);
    if (!n || n->score.evidence < options_.min_evidence) return;
    const Candidate& c = table.candidates()[n->candidate];
    const bool known = std::any_of(impossible_.begin(), impossible_.end(),
                                   [&](const auto& i) { return i.candidate.name == c.name; });
    if (!known) impossible_.push_back({c, n->score.size[0]});
  }

  // Backwards: what the later causes have made superfluous goes, and what predicts held-out blocks
  // worse than its absence.
  void prune() {
    while (!model_.accepted.empty()) {
      const ScoreTable& table = this->table();
      double least = options_.min_evidence;
      std::size_t least_at = model_.accepted.size();
      for (std::size_t a = 0; a < model_.accepted.size(); ++a) {
        const bool gains = gain_of_accepted(table, model_, a).total > 0.0;
        const double e = gains ? evidence_of(table, a) : -1e300;
        if (e < least) {
          least = e;
          least_at = a;
        }
      }
      if (least_at == model_.accepted.size()) break;
      CauseModel model = model_;
      drop(model, least_at);
      fit(model, 3);
      become(std::move(model));
    }
  }

  SearchResult conclude() {
    SearchResult result;
    const ScoreTable& table = this->table();
    const Eigen::MatrixXd covariance =
        model_.accepted.empty() ? Eigen::MatrixXd() : covariance_of(model_);
    for (std::size_t a = 0; a < model_.accepted.size(); ++a)
      result.verdicts.push_back(judge(table, covariance, a));
    std::stable_sort(result.verdicts.begin(), result.verdicts.end(),
                     [](const Verdict& a, const Verdict& b) { return a.evidence > b.evidence; });
    for (const Candidate& c : table.candidates())
      if (c.kind == CandidateKind::kNamed) result.looked_for.push_back(c.name);
    result.not_observable = not_observable(table);
    // What stands in a set was seen, if not told apart.
    for (const Verdict& v : result.verdicts)
      for (const std::string& name : v.inseparable) std::erase(result.not_observable, name);
    result.model = model_;
    result.impossible = impossible_;
    return result;
  }

  [[nodiscard]] Verdict judge(const ScoreTable& table,
                              const Eigen::MatrixXd& covariance,
                              std::size_t a) const {
    Verdict v;
    v.cause = model_.accepted[a];
    const auto [first, count] = table.accepted_range(a);
    const auto at = static_cast<Eigen::Index>(first);
    v.sigma = std::sqrt(covariance(at, at));
    v.statistic = 2.0 * table.loss_without(a);
    v.p = std::min(1.0, chi_squared_tail(v.statistic, static_cast<int>(count)) * table.tests());
    v.evidence = evidence_of(table, a);
    v.gain = gain_of_accepted(table, model_, a);
    const double own = table.loss_without(a);
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      const Candidate& candidate = table.candidates()[c];
      if (candidate.kind != CandidateKind::kNamed || is_accepted(candidate)) continue;
      const Score s = table.score_without(c, a);
      // A size far beyond the plausible is no alternative, an impossible one even less.
      if (s.size.size() != 1 || std::abs(s.size[0]) > 5.0 * candidate.tau ||
          !is_possible(candidate, s.size[0]))
        continue;
      if (own - 0.5 * s.statistic < options_.inseparable) v.inseparable.push_back(candidate.name);
    }
    return v;
  }

  // Effects that even at twice their plausible size would not have been named.
  [[nodiscard]] std::vector<std::string> not_observable(const ScoreTable& table) const {
    std::vector<std::string> names;
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      const Candidate& candidate = table.candidates()[c];
      if (candidate.kind != CandidateKind::kNamed || is_accepted(candidate)) continue;
      const Score s = table.score(c);
      constexpr double kNamed = 5.0;  // [sigma] where half of the causes are named
      if (2.0 * candidate.tau * std::sqrt(s.information(0, 0)) < kNamed)
        names.push_back(candidate.name);
    }
    return names;
  }

  const CauseProblem& problem_;
  const SearchOptions& options_;
  CauseModel model_;
  std::optional<ScoreTable> table_;
  std::vector<Impossible> impossible_;
};

}  // namespace

SearchResult search_causes(const CauseProblem& problem, const SearchOptions& options) {
  return Search(problem, options).run();
}

}  // namespace roadbook
