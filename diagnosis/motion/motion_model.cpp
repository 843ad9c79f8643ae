#include "diagnosis/motion/motion_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/normal_equations.hpp"

namespace roadbook {
namespace {

double largest_shift(const Elimination::Solution& solution) {
  double largest = 0.0;
  for (const auto& knot : solution.knots)
    largest = std::max({largest, std::abs(knot[kX]), std::abs(knot[kY])});
  return largest;
}

constexpr int kDiscIterations = 10;
// As much as a disc's centre and radius may be off where nothing shows them: 3 m.
constexpr double kDiscPrecision = 1.0 / 9.0;

bool has_discs(const MotionModel& model) {
  return std::any_of(model.accepted.begin(), model.accepted.end(),
                     [](const Accepted& a) { return a.candidate.kind == CandidateKind::kPlace; });
}

// Accepted discs whose edges show: those of some size.
std::vector<std::size_t> discs_of(const MotionModel& model) {
  std::vector<std::size_t> discs;
  for (std::size_t a = 0; a < model.accepted.size(); ++a)
    if (model.accepted[a].candidate.kind == CandidateKind::kPlace &&
        model.accepted[a].size[0] != 0.0)
      discs.push_back(a);
  return discs;
}

// Change of the sizes in order, then of the discs; no disc moves or grows by more than `most_m`.
Eigen::VectorXd solved_step(const Normal& normal,
                            Eigen::Index sizes,
                            const MotionModel& model,
                            const SizePrior& others,
                            double most_m) {
  // Exactly inseparable causes leave F singular: the least change among all equal ones.
  Eigen::MatrixXd held = normal.F;
  held.diagonal() *= 1.0 + 1e-10;
  held.diagonal().tail(held.rows() - sizes).array() += kDiscPrecision;
  Eigen::VectorXd score = normal.u;
  if (!others.empty()) {
    held.topLeftCorner(sizes, sizes) += others.information;
    score.head(sizes) += others.score(sizes_of({model.accepted, {}, {}, 0.0}));
  }
  Eigen::VectorXd step = held.ldlt().solve(score);
  auto discs = step.tail(step.size() - sizes);
  discs = discs.cwiseMax(-most_m).cwiseMin(most_m).eval();
  return step;
}

// The sizes in order, and behind them centre and radius of the discs.
void take_step(const Eigen::VectorXd& step,
               const std::vector<std::size_t>& discs,
               MotionModel& model) {
  constexpr double kLeastRadius = 0.5;  // [m]
  Eigen::Index at = 0;
  for (Accepted& a : model.accepted) {
    a.size += step.segment(at, a.size.size());
    if (a.candidate.kind == CandidateKind::kNamed)
      size_of(model.point.effects, a.candidate) = size_of(model.known, a.candidate) + a.size[0];
    at += a.size.size();
  }
  for (const std::size_t a : discs) {
    Candidate& disc = model.accepted[a].candidate;
    const double along = step[at++];
    disc.place_x += along * std::cos(disc.place_heading);
    disc.place_y += along * std::sin(disc.place_heading);
    disc.place_radius = std::max(disc.place_radius + step[at++], kLeastRadius);
  }
}

// With centres and radii of the discs, which stand behind, projected out.
Eigen::MatrixXd information_of_sizes(const Eigen::MatrixXd& F, Eigen::Index sizes) {
  const Eigen::Index discs = F.rows() - sizes;
  if (discs == 0) return F;
  Eigen::MatrixXd of_discs = F.bottomRightCorner(discs, discs);
  of_discs.diagonal().array() += kDiscPrecision;
  return F.topLeftCorner(sizes, sizes) -
         F.topRightCorner(sizes, discs) *
             of_discs.ldlt().solve(F.bottomLeftCorner(discs, sizes).eval());
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
  if (iterations > 1 && has_discs(model)) iterations = std::max(iterations, kDiscIterations);
  std::optional<MotionModel> best;
  double most_m = 0.5;
  for (int i = 0; i < iterations; ++i) {
    // Where an edge lies between two steps of the wheels the likelihood bends: no longer step there
    // and back.
    if (best && model.log_likelihood <= best->log_likelihood)
      most_m *= 0.5;
    else if (i > 0)
      best = model;
    renew_residual(obs, model);
    const std::vector<std::size_t> discs = discs_of(model);
    Columns columns = accepted_columns(obs, model);
    const auto sizes = static_cast<Eigen::Index>(columns.count());
    columns.append(moving_discs(obs, model.point, model.accepted, discs));
    const Pass pass = run_pass(obs, model.point, model.noise, columns, {true, 0, &model.inflation});
    const Normal normal = normal_equations(pass.innovations, columns.count());
    const Eigen::VectorXd step = solved_step(normal, sizes, model, others, most_m);
    std::vector<double> weights(pass.innovations.sides, 0.0);
    weights[0] = 1.0;
    for (Eigen::Index k = 0; k < step.size(); ++k)
      weights[1 + static_cast<std::size_t>(k)] = -step[k];
    take_step(step, discs, model);
    const auto solution = pass.elimination.back_substitute(weights);
    apply_solution(solution, model.point.trajectory);
    model.information = information_of_sizes(normal.F, sizes);
    const double gain = step.size() > 0 ? step.dot(2.0 * normal.u - normal.F * step) : 0.0;
    model.log_likelihood = -0.5 * (normal.squares - gain);
    // A tenth of a standard deviation and a millimetre: the next step would change nothing.
    const double moved = step.size() > 0 ? step.dot(normal.F * step) : 0.0;
    if (moved < 0.01 && largest_shift(solution) < 1e-3) break;
  }
  // About a large cause a whole step may go too far.
  const double worse = has_discs(model) ? 0.1 : 3.0;  // [nats]
  if (best && model.log_likelihood < best->log_likelihood - worse) model = std::move(*best);
  renew_residual(obs, model);
}

double& size_of(MotionEffects& effects, const Candidate& named) {
  return motion_effects()[named.effect].size(effects);
}

}  // namespace roadbook
