#include "diagnosis/inference/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "diagnosis/inference/acceptance.hpp"
#include "diagnosis/inference/cause_evidence.hpp"
#include "diagnosis/inference/competing_terms.hpp"
#include "diagnosis/inference/shortlist.hpp"

namespace roadbook {
namespace {

class Search {
 public:
  Search(const CauseProblem& problem, const SearchOptions& options)
      : problem_(problem),
        options_(options),
        acceptance_(problem, options),
        model_(problem.start()) {}

  SearchResult run() {
    for (std::size_t round = 0; round < options_.max_causes; ++round) {
      if (!extend(table())) break;
      swap_pass(1);
    }
    name_terms();
    prune();
    // What is left may have lost its companion: once more.
    swap_pass(0);
    prune();
    // What took the place of others has to gain on held-out blocks as they had to.
    for (std::size_t before = 0; before != model_.accepted.size();) {
      plainest();
      unlist();
      before = model_.accepted.size();
      prune();
    }
    replace();
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

  bool extend(const ScoreTable& table) {
    std::optional<CauseModel> best_model;
    double best = 0.0;
    note_impossible(table, options_.min_evidence, impossible_);
    for (const Nominee& n : nominate(table, options_.nominees)) {
      // A refit changes a score, but it does not double it.
      if ((best_model && n.score.evidence < 0.5 * best) || !acceptance_.admits(table, n)) continue;
      Candidate c = table.candidates()[n.candidate];
      if (c.kind == CandidateKind::kPlace) c = refined_place(problem_, model_, c);
      CauseModel model = model_;
      accept(model, c);
      fit(model, 3);
      if (c.kind == CandidateKind::kPlace) settle_place(problem_, model, model.accepted.size() - 1);
      if (!(model.log_likelihood > model_.log_likelihood)) continue;
      if (!is_possible(c, model.accepted.back().size[0])) continue;
      // A name that explains the data about as well as a term of the grammar is the better answer.
      const double handicap = c.kind == CandidateKind::kGrammar ? options_.inseparable : 0.0;
      const double evidence =
          refitted_evidence(model, c.penalty + std::log(table.tests())) - handicap;
      if (evidence < acceptance_.least_evidence(table, c)) continue;
      if (best_model && evidence <= best) continue;
      best = evidence;
      best_model = std::move(model);
    }
    if (!best_model) return false;
    become(std::move(*best_model));
    return true;
  }

  // Whether a term of the grammar says what an accepted name says, and little more: as in
  // `nominate`, the name is the better answer.
  [[nodiscard]] bool has_its_name(const ScoreTable& table,
                                  std::size_t a,
                                  std::size_t c,
                                  const Score& s) const {
    return model_.accepted[a].candidate.kind == CandidateKind::kNamed &&
           table.candidates()[c].kind == CandidateKind::kGrammar &&
           2.0 * table.loss_without(a) >= enough_for_a_name(s, table);
  }

  [[nodiscard]] bool both_named(const ScoreTable& table, std::size_t a, std::size_t c) const {
    return model_.accepted[a].candidate.kind == CandidateKind::kNamed &&
           table.candidates()[c].kind == CandidateKind::kNamed;
  }

  // An earlier name may now lose to another; the last ones, `settled` in number, were just
  // chosen. In the end (none settled) only to another name.
  void swap_pass(std::size_t settled) {
    for (std::size_t a = 0; a + settled < model_.accepted.size(); ++a) {
      const ScoreTable& table = this->table();
      const double own = evidence_of(model_, table, a);
      double best = own + 1.0;
      std::size_t best_at = table.candidates().size();
      for (std::size_t c = 0; c < table.candidates().size(); ++c) {
        if (is_accepted(model_, table.candidates()[c])) continue;
        const Score s = table.score_without(c, a);
        if (s.evidence > best && !has_its_name(table, a, c, s) &&
            is_possible(table.candidates()[c], s.size[0]) &&
            (settled > 0 || both_named(table, a, c))) {
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
      // What is linear says so; the refit has to agree.
      if (model.log_likelihood > model_.log_likelihood - 1.0 &&
          refitted_evidence(model, other.penalty + std::log(table.tests())) > own + 1.0)
        become(std::move(model));
    }
  }

  // The model with the best named cause beside the others, if there is one.
  [[nodiscard]] CauseModel with_best_name(const CauseModel& model) const {
    const ScoreTable table(model, problem_.project(model, problem_.candidates(model)));
    std::optional<Nominee> best;
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      if (table.candidates()[c].kind != CandidateKind::kNamed) continue;
      const Nominee n{c, table.score(c)};
      if (!is_possible(table.candidates()[c], n.score.size[0])) continue;
      if (!best || n.score.evidence > best->score.evidence) best = n;
    }
    if (!best || best->score.evidence < options_.min_evidence) return model;
    CauseModel named = model;
    accept(named, table.candidates()[best->candidate]);
    fit(named, 3);
    return named;
  }

  // A term of the grammar may be a name after all, or two at once of which no single one explains
  // it; and several terms what is too far off for one of them to be a name.
  void name_terms() {
    for (std::size_t a = model_.accepted.size(); a-- > 0;)
      if (model_.accepted[a].candidate.kind == CandidateKind::kGrammar) name_terms({a});
    std::vector<std::size_t> terms;
    for (std::size_t a = 0; a < model_.accepted.size(); ++a)
      if (model_.accepted[a].candidate.kind == CandidateKind::kGrammar) terms.push_back(a);
    if (terms.size() > 1) name_terms(terms);
  }

  void name_terms(const std::vector<std::size_t>& terms) {
    const double lost = table().loss_without(terms);
    double freedom = 0.0;
    CauseModel other = model_;
    for (auto a = terms.rbegin(); a != terms.rend(); ++a) {
      freedom += static_cast<double>(model_.accepted[*a].candidate.columns.size());
      drop(other, *a);
    }
    fit(other, 3);
    // One name may lose as much as in `nominate`, two no more than chance where residuals are
    // white.
    const double chance = 3.0 + freedom;
    const double most = std::max(chance, 0.02 * lost);
    const std::array<double, 2> slack{most, is_white(table(), problem_.channels()) ? chance : most};
    const double whole = model_.log_likelihood;
    for (std::size_t names = 0; names < slack.size(); ++names) {
      const std::size_t before = other.accepted.size();
      other = with_best_name(other);
      if (other.accepted.size() == before) return;
      if (other.log_likelihood < whole - slack[names]) continue;
      become(std::move(other));
      return;
    }
  }

  // What other data have decided.
  void replace() {
    for (const auto& [name, other] : options_.instead)
      for (std::size_t a = 0; a < model_.accepted.size(); ++a)
        if (model_.accepted[a].candidate.name == name)
          become(with_other_name(problem_, model_, table(), a, other));
  }

  // Of names that explain the data equally well (left and right radius, or their mean and
  // difference) those that need the least.
  void plainest() {
    for (std::size_t a = 0; a < model_.accepted.size(); ++a) {
      if (model_.accepted[a].candidate.kind != CandidateKind::kNamed) continue;
      const ScoreTable& table = this->table();
      const double own = table.loss_without(a);
      CauseModel best = model_;
      for (std::size_t c = 0; c < table.candidates().size(); ++c) {
        const Candidate& other = table.candidates()[c];
        if (other.kind != CandidateKind::kNamed || is_accepted(model_, other)) continue;
        if (own - 0.5 * table.score_without(c, a).statistic > 1.0) continue;
        CauseModel model = model_;
        drop(model, a);
        accept(model, other);
        fit(model, 3);
        const bool possible = is_possible(other, model.accepted.back().size[0]);
        if (possible && model.log_likelihood > model_.log_likelihood - 1.0 &&
            unlikeliness(model) < unlikeliness(best) - 1.0)
          best = std::move(model);
      }
      if (unlikeliness(best) < unlikeliness(model_)) become(std::move(best));
    }
  }

  // Names may together say what is one thing that nobody listed, or one name about that.
  void unlist() {
    for (;;) {
      Unlisted u = unlisted(problem_, model_, table(), options_.inseparable);
      doubts_ = std::move(u.doubts);
      if (!u.model) return;
      become(std::move(*u.model));
    }
  }

  // Backwards: what the later causes have made superfluous goes, and what predicts held-out blocks
  // worse than its absence, or not surely better where that is all that can be relied on.
  void prune() {
    while (!model_.accepted.empty()) {
      const ScoreTable& table = this->table();
      double least = 0.0;
      std::size_t least_at = model_.accepted.size();
      for (std::size_t a = 0; a < model_.accepted.size(); ++a)
        if (const double s = acceptance_.surplus(model_, table, a); s < least) {
          least = s;
          least_at = a;
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
    const bool white = is_white(table, problem_.channels());
    for (std::size_t a = 0; a < model_.accepted.size(); ++a) {
      result.verdicts.push_back(verdict_of(model_, table, a, options_.in_set, white));
      Verdict& v = result.verdicts.back();
      if (problem_.gains_need_refit()) v.gain = gain_against_refit(problem_, table, model_, a);
      v.sigma = std::max(v.sigma, profile_sigma(problem_, model_, a));
      if (problem_.intervals_of_blocks()) v.sigma *= std::max(1.0, table.block_scatter(a));
      add_refitted(problem_, model_, table, a, options_.in_set, v);
      for (const std::size_t c : like_covariates(model_, table, a, options_.inseparable))
        v.covariates.push_back(table.candidates()[c].covariate);
    }
    std::stable_sort(result.verdicts.begin(), result.verdicts.end(),
                     [](const Verdict& a, const Verdict& b) { return a.evidence > b.evidence; });
    for (const Candidate& c : table.candidates())
      if (c.kind == CandidateKind::kNamed) result.looked_for.push_back(c.name);
    result.not_observable = not_observable(model_, table);
    // What stands in a set was seen, if not told apart.
    for (const Verdict& v : result.verdicts)
      for (const std::string& name : v.inseparable) std::erase(result.not_observable, name);
    // Nor is what a term says as its mean hidden.
    for (const Accepted& a : model_.accepted)
      std::erase(result.not_observable, a.candidate.named_mean);
    result.model = model_;
    result.impossible = impossible_;
    result.doubts = doubts_;
    for (Doubt& d : doubts_of(problem_, model_, table)) result.doubts.push_back(std::move(d));
    return result;
  }

  const CauseProblem& problem_;
  const SearchOptions& options_;
  Acceptance acceptance_;
  CauseModel model_;
  std::optional<ScoreTable> table_;
  std::vector<Impossible> impossible_;
  std::vector<Doubt> doubts_;
};

}  // namespace

SearchResult search_causes(const CauseProblem& problem, const SearchOptions& options) {
  return Search(problem, options).run();
}

}  // namespace roadbook
