#include "diagnosis/oracle.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/score_table.hpp"

namespace roadbook {

OracleAnswer ask_oracle(const MotionStreams& streams, const EffectSizes& hidden) {
  OracleAnswer answer;
  if (hidden.empty()) return answer;
  DiagnosisOptions options;
  options.library.places = options.library.grammar = false;
  const PreparedMotion prepared = prepare_motion(streams, "drive", options);
  const MotionProblem& problem = *prepared.problem;
  const CauseModel nominal = problem.nominal();
  const ScoreTable table(nominal, problem.project(nominal, problem.candidates(nominal)));
  MotionModel truth = motion_model(nominal);
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Candidate& candidate = table.candidates()[c];
    const auto size = hidden.find(candidate.name);
    if (size == hidden.end()) continue;
    const double information = std::max(table.score(c).information(0, 0), 0.0);
    answer.strength = std::max(answer.strength, std::abs(size->second) * std::sqrt(information));
    size_of(truth.known, candidate) = size->second;
  }
  truth.point.effects = truth.known;
  fit_model(problem.observations(), truth, 5);
  answer.gain = truth.log_likelihood - nominal.log_likelihood;
  return answer;
}

}  // namespace roadbook
