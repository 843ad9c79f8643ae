#include "diagnosis/motion_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/motion_prediction.hpp"
#include "diagnosis/normal_equations.hpp"

namespace roadbook {
namespace {

double largest_shift(const Elimination::Solution& solution) {
  double largest = 0.0;
  for (const auto& knot : solution.knots)
    largest = std::max({largest, std::abs(knot[kX]), std::abs(knot[kY])});
  return largest;
}

}  // namespace

Columns accepted_columns(const Observations& obs, const MotionModel& model) {
  std::vector<Candidate> of;
  for (const Accepted& a : model.accepted) of.push_back(a.candidate);
  return candidate_columns(obs, model.point, of);
}

void renew_residual(const Observations& obs, MotionModel& model) {
  model.point.residual = row_residuals(obs, model.point.trajectory, model.point.effects);
  const auto first = obs.offsets();
  for (const Accepted& a : model.accepted) {
    if (a.candidate.kind == CandidateKind::kNamed) continue;
    const Columns columns = candidate_columns(obs, model.point, {a.candidate});
    for (std::size_t c = 0; c < kChannels; ++c)
      for (const Columns::Part& part : columns.of(static_cast<Channel>(c)))
        for (std::size_t k = 0; k < part.values.size(); ++k)
          model.point.residual[first[c] + k] -=
              part.values[k] * a.size[static_cast<Eigen::Index>(part.column)];
  }
}

void fit_model(const Observations& obs,
               MotionModel& model,
               int iterations,
               const SizePrior& others) {
  std::optional<MotionModel> best;
  for (int i = 0; i < iterations; ++i) {
    if (i > 0 && (!best || model.log_likelihood > best->log_likelihood)) best = model;
    renew_residual(obs, model);
    const Columns columns = accepted_columns(obs, model);
    const Pass pass = run_pass(obs, model.point, model.noise, columns, {true, 0, &model.inflation});
    const Normal normal = normal_equations(pass.innovations, columns.count());
    // Exactly inseparable causes leave F singular: the least change among all equal ones.
    Eigen::MatrixXd held = normal.F;
    held.diagonal() *= 1.0 + 1e-10;
    Eigen::VectorXd score = normal.u;
    if (!others.empty()) {
      held += others.information;
      score += others.score(sizes_of({model.accepted, {}, {}, 0.0}));
    }
    const Eigen::VectorXd step = held.ldlt().solve(score);
    std::vector<double> weights(pass.innovations.sides, 0.0);
    weights[0] = 1.0;
    for (Eigen::Index k = 0; k < step.size(); ++k)
      weights[1 + static_cast<std::size_t>(k)] = -step[k];
    Eigen::Index at = 0;
    for (Accepted& a : model.accepted) {
      a.size += step.segment(at, a.size.size());
      if (a.candidate.kind == CandidateKind::kNamed)
        size_of(model.point.effects, a.candidate) = size_of(model.known, a.candidate) + a.size[0];
      at += a.size.size();
    }
    const auto solution = pass.elimination.back_substitute(weights);
    apply_solution(solution, model.point.trajectory);
    model.information = normal.F;
    const double gain = step.size() > 0 ? step.dot(2.0 * normal.u - normal.F * step) : 0.0;
    model.log_likelihood = -0.5 * (normal.squares - gain);
    // A tenth of a standard deviation and a millimetre: the next step would change nothing.
    const double moved = step.size() > 0 ? step.dot(normal.F * step) : 0.0;
    if (moved < 0.01 && largest_shift(solution) < 1e-3) break;
  }
  // About a large cause a whole step may go too far.
  constexpr double kWorse = 3.0;  // [nats]
  if (best && model.log_likelihood < best->log_likelihood - kWorse) model = std::move(*best);
  renew_residual(obs, model);
}

double& size_of(MotionEffects& effects, const Candidate& named) {
  return motion_effects()[named.effect].size(effects);
}

}  // namespace roadbook
