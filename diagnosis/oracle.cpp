#include "diagnosis/oracle.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/detector/foot_position_problem.hpp"
#include "diagnosis/detector/recall_problem.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/friction/friction_problem.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/range/fitted_mixture.hpp"
#include "diagnosis/tilt/tilt_problem.hpp"

namespace roadbook {
namespace {

void add_answer(const OracleAnswer& more, OracleAnswer& all) {
  all.strength = std::max(all.strength, more.strength);
  all.gain += more.gain;
  if (more.weakest && (!all.weakest || *more.weakest < *all.weakest)) all.weakest = more.weakest;
}

// Information of the accepted sizes, each with the others free.
std::optional<double> weakest_of(const CauseProblem& problem, const CauseModel& model) {
  if (model.accepted.empty()) return std::nullopt;
  const ScoreTable table(model, problem.project(model, {}));
  double least = 1e300;
  for (std::size_t a = 0; a < model.accepted.size(); ++a)
    least = std::min(least, std::sqrt(2.0 * table.loss_without(a)));
  return least;
}

// Each effect fitted alone, then moved to its true size along the parabola about the optimum: exact
// where the readings are linear in it.
OracleAnswer of_problem(const CauseProblem& problem, const EffectSizes& hidden) {
  OracleAnswer all;
  const CauseModel nominal = problem.nominal();
  const ScoreTable table(nominal, problem.project(nominal, problem.candidates(nominal)));
  CauseModel knowing = nominal;
  for (const Candidate& c : table.candidates()) {
    const auto size = hidden.find(c.name);
    if (size == hidden.end() || c.kind == CandidateKind::kGrammar) continue;
    accept(knowing, c);
    knowing.accepted.back().size[0] = size->second;
    CauseModel fitted = nominal;
    accept(fitted, c);
    problem.fit(fitted, 10);
    const double information = std::max(fitted.information(0, 0), 0.0);
    const double off = size->second - fitted.accepted.front().size[0];
    add_answer({std::abs(size->second) * std::sqrt(information),
                fitted.log_likelihood - nominal.log_likelihood - 0.5 * information * off * off,
                {}},
               all);
    if (c.kind == CandidateKind::kPlace) break;  // the best place alone
  }
  all.weakest = weakest_of(problem, knowing);
  return all;
}

OracleAnswer of_ranges(const RangeReadings& readings, const EffectSizes& hidden) {
  OracleAnswer all;
  const double nominal = fit_mixture(readings, {}).log_likelihood;
  RangeParts hidden_parts{};
  for (std::size_t k = 0; k < kRangeParts; ++k) {
    const auto size = hidden.find(range_part_name(k));
    if (size == hidden.end()) continue;
    RangeParts parts{};
    parts[k] = hidden_parts[k] = true;
    RangeMixture m = fit_mixture(readings, parts);
    m.share[k] = size->second;
    double known = 0.0;
    for (const ExpectedRange& r : readings.samples)
      known += std::log(range_densities(r, m, readings.max_m).of(m));
    add_answer({size->second / std::max(m.sigma[k], 1e-12), known - nominal, {}}, all);
  }
  const RangeMixture beside = fit_mixture(readings, hidden_parts);
  for (std::size_t k = 0; k < kRangeParts; ++k)
    if (hidden_parts[k])
      add_answer({0.0, 0.0, beside.share[k] / std::max(beside.sigma[k], 1e-12)}, all);
  return all;
}

}  // namespace

OracleAnswer ask_oracle(const MotionStreams& streams, const EffectSizes& hidden) {
  OracleAnswer answer;
  if (hidden.empty()) return answer;
  DiagnosisOptions options;
  options.library.places = options.library.grammar = false;
  const PreparedMotion prepared = prepare_motion(streams, "drive", options);
  const TiltProblem tilt(tilt_windows(streams, options.observation.step_s), tilt_axes(streams.imu),
                         streams.bank_is_known);
  const MotionProblem& problem = *prepared.problem;
  const CauseModel nominal = problem.nominal();
  const ScoreTable table(nominal, problem.project(nominal, problem.candidates(nominal)));
  MotionModel truth = motion_model(nominal);
  CauseModel knowing = nominal;
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Candidate& candidate = table.candidates()[c];
    const auto size = hidden.find(candidate.name);
    if (size == hidden.end()) continue;
    const double information = std::max(table.score(c).information(0, 0), 0.0);
    answer.strength = std::max(answer.strength, std::abs(size->second) * std::sqrt(information));
    size_of(truth.known, candidate) = size->second;
    accept(knowing, candidate);
    knowing.accepted.back().size[0] = size->second;
  }
  truth.point.effects = truth.known;
  fit_model(problem.observations(), truth, 5);
  answer.gain = truth.log_likelihood - nominal.log_likelihood;
  answer.weakest = hidden.size() == 1 && !knowing.accepted.empty() ? std::optional(answer.strength)
                                                                   : weakest_of(problem, knowing);
  if (tilt.usable()) add_answer(of_problem(tilt, hidden), answer);
  return answer;
}

OracleAnswer ask_oracle(const DriveReadings& readings, const EffectSizes& hidden) {
  OracleAnswer all;
  if (hidden.empty()) return all;
  LibraryOptions library;
  library.grammar = false;
  if (!readings.friction.samples.empty())
    add_answer(of_problem(FrictionProblem(readings.friction, library), hidden), all);
  if (!readings.ranges.samples.empty()) add_answer(of_ranges(readings.ranges, hidden), all);
  if (readings.people.looks.empty()) return all;
  const auto tracks = person_tracks(readings.people);
  const FootPositionProblem feet(readings.people, tracks, library);
  if (feet.usable()) add_answer(of_problem(feet, hidden), all);
  const RecallProblem recall(readings.people, tracks, library);
  if (recall.usable()) add_answer(of_problem(recall, hidden), all);
  return all;
}

}  // namespace roadbook
