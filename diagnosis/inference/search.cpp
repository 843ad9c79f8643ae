#include "diagnosis/inference/search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "diagnosis/inference/acceptance.hpp"
#include "diagnosis/inference/cause_evidence.hpp"
#include "diagnosis/inference/competing_terms.hpp"
#include "diagnosis/inference/lack_of_fit.hpp"
#include "diagnosis/inference/lasting_errors.hpp"
#include "diagnosis/inference/shortlist.hpp"

namespace roadbook {
namespace {

constexpr double kMostLastingP = 0.05;  // after correction for the number of candidates

// Stepwise model selection, with each candidate model refitted in full:
//
//   1. add:     the best shortlisted effect, until none has enough evidence (add_best_effect);
//   2. replace: after each addition, an earlier effect that another one explains better
//               (replace_weaker_effects);
//   3. name:    a generic effect that one or two catalogued effects explain (explain_by_catalogue);
//   4. prune:   effects that do not improve the held-out likelihood (prune_effects);
//   5. tidy:    among equally good effects those of the smallest sizes (prefer_smallest_sizes), and
//               a generic effect instead of catalogued ones that only imitate it
//               (prefer_generic_terms), then prune again, until nothing changes.
//   6. doubt:   effects that errors of the reference that last explain as well.
//
// docs/design/diagnosis_method.md explains each step.
class Search {
 public:
  Search(const CauseProblem& problem, const SearchOptions& options)
      : problem_(problem),
        options_(options),
        acceptance_(problem, options),
        model_(problem.start()) {}

  SearchResult run() {
    for (std::size_t round = 0; round < options_.max_causes; ++round) {
      if (!add_best_effect(table())) break;
      replace_weaker_effects(1);
    }
    explain_by_catalogue();
    prune_effects();
    // Pruning may have removed a companion of an effect: replace and prune a second time.
    replace_weaker_effects(0);
    prune_effects();
    // Effects that replaced others must improve the held-out likelihood too.
    for (std::size_t before = 0; before != model_.accepted.size();) {
      prefer_smallest_sizes();
      prefer_generic_terms();
      before = model_.accepted.size();
      prune_effects();
    }
    doubt_what_lasting_errors_show();
    apply_decisions();
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
  void set_model(CauseModel model) {
    model_ = std::move(model);
    table_.reset();
  }

  bool add_best_effect(const ScoreTable& table) {
    std::optional<CauseModel> best_model;
    double best = 0.0;
    note_impossible(table, options_.min_evidence, impossible_);
    for (const Shortlisted& n : shortlist_candidates(table, options_.nominees)) {
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
      // A catalogued effect that explains the data about as well as a generic one is preferred.
      const double handicap = c.kind == CandidateKind::kGrammar ? options_.replacement_lead : 0.0;
      const double evidence =
          refitted_evidence(model, c.penalty + std::log(table.tests())) - handicap;
      if (evidence < acceptance_.least_evidence(table, c)) continue;
      if (best_model && evidence <= best) continue;
      best = evidence;
      best_model = std::move(model);
    }
    if (!best_model) return false;
    set_model(std::move(*best_model));
    return true;
  }

  // Whether accepted catalogued effect `a` explains nearly all that generic effect `c` explains.
  // Then the catalogued effect is preferred, as in `shortlist_candidates`.
  [[nodiscard]] bool is_explained_by(const ScoreTable& table,
                                     std::size_t a,
                                     std::size_t c,
                                     const Score& s) const {
    return model_.accepted[a].candidate.kind == CandidateKind::kNamed &&
           table.candidates()[c].kind == CandidateKind::kGrammar &&
           2.0 * table.loss_without(a) >= statistic_to_explain_term(s, table);
  }

  [[nodiscard]] bool both_catalogued(const ScoreTable& table, std::size_t a, std::size_t c) const {
    return model_.accepted[a].candidate.kind == CandidateKind::kNamed &&
           table.candidates()[c].kind == CandidateKind::kNamed;
  }

  // Replaces each accepted effect by a candidate that has more evidence in its place. The last
  // `settled` effects were just chosen and stay. With none settled (at the end), a catalogued
  // effect is replaced by another catalogued one only.
  void replace_weaker_effects(std::size_t settled) {
    for (std::size_t a = 0; a + settled < model_.accepted.size(); ++a) {
      const ScoreTable& table = this->table();
      const double own = evidence_of(model_, table, a);
      double best = own + 1.0;
      std::size_t best_at = table.candidates().size();
      for (std::size_t c = 0; c < table.candidates().size(); ++c) {
        if (is_accepted(model_, table.candidates()[c])) continue;
        const Score s = table.score_without(c, a);
        if (s.evidence > best && !is_explained_by(table, a, c, s) &&
            is_possible(table.candidates()[c], s.size[0]) &&
            (settled > 0 || both_catalogued(table, a, c))) {
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
      // The scores are of a linearised model: the refit has to agree.
      if (model.log_likelihood > model_.log_likelihood - 1.0 &&
          refitted_evidence(model, other.penalty + std::log(table.tests())) > own + 1.0)
        set_model(std::move(model));
    }
  }

  // The model with the best catalogued effect added; `model` itself where none has enough evidence.
  [[nodiscard]] CauseModel with_best_catalogued(const CauseModel& model) const {
    const ScoreTable table(model, problem_.project(model, problem_.candidates(model)));
    std::optional<Shortlisted> best;
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      if (table.candidates()[c].kind != CandidateKind::kNamed) continue;
      const Shortlisted n{c, table.score(c)};
      if (!is_possible(table.candidates()[c], n.score.size[0])) continue;
      if (!best || n.score.evidence > best->score.evidence) best = n;
    }
    if (!best || best->score.evidence < options_.min_evidence) return model;
    CauseModel named = model;
    accept(named, table.candidates()[best->candidate]);
    fit(named, 3);
    return named;
  }

  // Replaces a generic effect by one or two catalogued effects that explain it, and several generic
  // effects together by one catalogued effect of a size that no linearisation reaches.
  void explain_by_catalogue() {
    for (std::size_t a = model_.accepted.size(); a-- > 0;)
      if (model_.accepted[a].candidate.kind == CandidateKind::kGrammar) explain_by_catalogue({a});
    std::vector<std::size_t> terms;
    for (std::size_t a = 0; a < model_.accepted.size(); ++a)
      if (model_.accepted[a].candidate.kind == CandidateKind::kGrammar) terms.push_back(a);
    if (terms.size() > 1) explain_by_catalogue(terms);
  }

  void explain_by_catalogue(const std::vector<std::size_t>& terms) {
    const double lost = table().loss_without(terms);
    double freedom = 0.0;
    CauseModel other = model_;
    for (auto a = terms.rbegin(); a != terms.rend(); ++a) {
      freedom += static_cast<double>(model_.accepted[*a].candidate.columns.size());
      drop(other, *a);
    }
    fit(other, 3);
    // One catalogued effect may lose as much as in `shortlist_candidates`. Two may lose no more
    // than random noise gives, if residuals are white.
    const double chance = 3.0 + freedom;
    const double most = std::max(chance, 0.02 * lost);
    const std::array<double, 2> slack{most, is_white(table(), problem_.channels()) ? chance : most};
    const double whole = model_.log_likelihood;
    for (std::size_t names = 0; names < slack.size(); ++names) {
      const std::size_t before = other.accepted.size();
      other = with_best_catalogued(other);
      if (other.accepted.size() == before) return;
      if (other.log_likelihood < whole - slack[names]) continue;
      set_model(std::move(other));
      return;
    }
  }

  // Replaces effects that other data have decided otherwise (`SearchOptions::instead`).
  void apply_decisions() {
    for (const auto& [name, other] : options_.instead)
      for (std::size_t a = 0; a < model_.accepted.size(); ++a)
        if (model_.accepted[a].candidate.name == name)
          set_model(with_other_name(problem_, model_, table(), a, other));
  }

  // Among catalogued effects that explain the data equally well (left and right radius, or their
  // mean and difference), takes those whose sizes have the highest prior density.
  void prefer_smallest_sizes() {
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
            prior_cost(model) < prior_cost(best) - 1.0)
          best = std::move(model);
      }
      if (prior_cost(best) < prior_cost(model_)) set_model(std::move(best));
    }
  }

  // Replaces catalogued effects by one generic effect that the catalogue lacks and they imitate.
  void prefer_generic_terms() {
    for (;;) {
      GenericReplacement u =
          replace_by_generic_term(problem_, model_, table(), options_.replacement_lead);
      doubts_ = std::move(u.doubts);
      if (!u.model) return;
      set_model(std::move(*u.model));
    }
  }

  // Backward step: removes effects that later ones have made superfluous, and effects that do not
  // improve the held-out likelihood significantly.
  void prune_effects() {
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
      set_model(std::move(model));
    }
  }

  [[nodiscard]] std::optional<Innovations> where_errors_last() const {
    const std::vector<std::size_t> channels = problem_.channels_of_reference();
    if (channels.empty() || model_.accepted.empty()) return std::nullopt;
    return without_autocorrelation(problem_.project(model_, {}), channels);
  }

  // P-values of the accepted effects, corrected, where errors may last; none where they do not.
  std::vector<double> p_where_errors_last() {
    std::vector<double> p;
    if (const auto white = where_errors_last())
      for (std::size_t a = 0; a < model_.accepted.size(); ++a)
        p.push_back(size_by_blocks(model_, *white, a).p * table().tests());
    return p;
  }

  // Removes catalogued effects that are not significant once errors may last, neither beside all
  // others nor beside those that stay. Only what remains when every effect is fitted says whether
  // errors last. Generic effects of this kind stay in the model, so that no other effect absorbs
  // their part of the data, but are no findings.
  void doubt_what_lasting_errors_show() {
    const auto is_name = [&](std::size_t a) {
      return model_.accepted[a].candidate.kind != CandidateKind::kGrammar;
    };
    std::vector<double> first = p_where_errors_last();
    std::vector<double> now = first;
    for (;;) {
      double most = kMostLastingP;
      std::size_t worst = now.size();
      for (std::size_t a = 0; a < now.size(); ++a)
        if (const double p = std::min(now[a], first[a]); is_name(a) && p > most) {
          most = p;
          worst = a;
        }
      if (worst == now.size()) return;
      doubted_.insert(model_.accepted[worst].candidate.name);
      CauseModel model = model_;
      drop(model, worst);
      first.erase(first.begin() + static_cast<std::ptrdiff_t>(worst));
      fit(model, 3);
      set_model(std::move(model));
      now = p_where_errors_last();
    }
  }

  // What the lasting errors took from the findings is neither found nor absent.
  void add_doubted(SearchResult& result) const {
    for (const std::string& name : doubted_) {
      const bool is_found =
          std::any_of(result.verdicts.begin(), result.verdicts.end(), [&](const AcceptedEffect& v) {
            const auto& others = v.inseparable;
            return v.cause.candidate.name == name ||
                   std::find(others.begin(), others.end(), name) != others.end();
          });
      if (is_found) continue;
      drop_name(result, name);
      result.hidden.push_back({name, "errors of the reference that last"});
      std::erase_if(result.doubts, [&](const FitWarning& d) { return d.name == name; });
    }
  }

  static void drop_name(SearchResult& result, const std::string& name) {
    std::erase(result.not_observable, name);
    std::erase_if(result.hidden, [&](const HiddenEffect& h) { return h.name == name; });
  }

  SearchResult conclude() {
    SearchResult result;
    const ScoreTable& table = this->table();
    const bool white = is_white(table, problem_.channels());
    const auto lasting = where_errors_last();
    for (std::size_t a = 0; a < model_.accepted.size(); ++a) {
      result.verdicts.push_back(judge_effect(model_, table, a, options_.confounded_loss, white));
      AcceptedEffect& v = result.verdicts.back();
      if (problem_.gains_need_refit()) v.gain = gain_against_refit(problem_, table, model_, a);
      v.sigma = std::max(v.sigma, profile_sigma(problem_, model_, a));
      if (problem_.intervals_of_blocks()) v.sigma *= std::max(1.0, table.block_scatter(a));
      if (lasting) {
        const SizeByBlocks there = size_by_blocks(model_, *lasting, a);
        v.sigma = std::max(v.sigma, there.sigma);
        v.p = std::min(1.0, std::max(v.p, there.p * table.tests()));
        v.of_lasting_errors = v.cause.candidate.kind == CandidateKind::kGrammar &&
                              there.p * table.tests() > kMostLastingP;
      }
      add_refitted(problem_, model_, table, a, options_.confounded_loss, v);
      for (const std::size_t c : like_covariates(model_, table, a, options_.replacement_lead))
        v.covariates.push_back(table.candidates()[c].covariate);
    }
    std::stable_sort(
        result.verdicts.begin(), result.verdicts.end(),
        [](const AcceptedEffect& a, const AcceptedEffect& b) { return a.evidence > b.evidence; });
    for (const Candidate& c : table.candidates())
      if (c.kind == CandidateKind::kNamed) result.looked_for.push_back(c.name);
    result.not_observable = not_observable(model_, table);
    result.hidden = hidden_effects(model_, table);
    // An effect in a confounded set is observable.
    for (const AcceptedEffect& v : result.verdicts)
      for (const std::string& name : v.inseparable) drop_name(result, name);
    // So is the mean of an accepted generic effect.
    for (const AcceptedEffect& v : result.verdicts)
      if (!v.of_lasting_errors) drop_name(result, v.cause.candidate.named_mean);
    result.model = model_;
    result.impossible = impossible_;
    result.doubts = doubts_;
    for (FitWarning& d : lack_of_fit_warnings(problem_, model_, table))
      result.doubts.push_back(std::move(d));
    add_doubted(result);
    return result;
  }

  const CauseProblem& problem_;
  const SearchOptions& options_;
  Acceptance acceptance_;
  CauseModel model_;
  std::optional<ScoreTable> table_;
  std::vector<Impossible> impossible_;
  std::vector<FitWarning> doubts_;
  std::set<std::string> doubted_;  // effects that lasting errors explain as well
};

}  // namespace

SearchResult search_causes(const CauseProblem& problem, const SearchOptions& options) {
  return Search(problem, options).run();
}

}  // namespace roadbook
