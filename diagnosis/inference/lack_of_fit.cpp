#include "diagnosis/inference/lack_of_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "diagnosis/inference/cause_evidence.hpp"

namespace roadbook {
namespace {

constexpr double kNameLevel = 0.05;       // for each name
constexpr double kAlikeColumns = 0.25;    // squared cosine of columns
constexpr double kMostRobustName = 0.01;  // by the scatter of one-second blocks

struct Lack {
  double p = 1.0;
  std::string what;
};

std::string text_of(const Lack& lack) {
  char p[40];
  std::snprintf(p, sizeof p, " (p = %.1g)", lack.p);
  return lack.what + p;
}

bool blocks_agree(const ScoreTable& table, std::size_t c, const Score& score) {
  return chi_squared_tail(table.robust_statistic(c), score.freedom) < kMostRobustName;
}

// The strongest test of one name, uncorrected; `tests`: how many there were.
void look(const ScoreTable& table,
          std::size_t c,
          const std::string& what,
          double& tests,
          std::optional<Lack>& worst) {
  const Score score = table.score(c);
  if (score.information.trace() <= 0.0) return;
  tests += 1.0;
  if ((!worst || score.p < worst->p) && blocks_agree(table, c, score)) worst = Lack{score.p, what};
}

void look_at_variations(const CauseProblem& problem,
                        const CauseModel& model,
                        const Candidate& name,
                        double& tests,
                        std::optional<Lack>& worst) {
  std::vector<Candidate> variations = problem.variations(model, name);
  if (variations.empty()) return;
  const ScoreTable varied(model, problem.project(model, std::move(variations)));
  for (std::size_t c = 0; c < varied.candidates().size(); ++c)
    look(varied, c, "its size depends on " + varied.candidates()[c].covariate, tests, worst);
}

}  // namespace

std::vector<FitWarning> lack_of_fit_warnings(const CauseProblem& problem,
                                             const CauseModel& model,
                                             const ScoreTable& table) {
  std::vector<FitWarning> doubts;
  for (std::size_t a = 0; a < model.accepted.size(); ++a) {
    const Candidate& name = model.accepted[a].candidate;
    if (name.kind != CandidateKind::kNamed) continue;
    double tests = 0.0;
    std::optional<Lack> worst;
    for (std::size_t c = 0; c < table.candidates().size(); ++c) {
      const Candidate& other = table.candidates()[c];
      if (other.kind == CandidateKind::kNamed && !is_accepted(model, other) &&
          table.made_up(c, a) > kAlikeColumns)
        look(table, c, "an effect like " + other.name + " remains in the residuals", tests, worst);
    }
    look_at_variations(problem, model, name, tests, worst);
    if (!worst) continue;
    worst->p = std::min(1.0, worst->p * tests);
    if (worst->p < kNameLevel) doubts.push_back({name.name, text_of(*worst)});
  }
  return doubts;
}

}  // namespace roadbook
