#include "diagnosis/motion_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "diagnosis/motion_prediction.hpp"

namespace roadbook {
namespace {

constexpr int kNoiseIterations = 4;
constexpr std::size_t kProbes = 4;

struct Normal {
  Eigen::MatrixXd F;
  Eigen::VectorXd u;
  double squares = 0.0;
  std::array<Eigen::MatrixXd, kChannels> by_channel;
};

// Normal equations of `count` columns from the innovations.
Normal normal_equations(const Innovations& in, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  Normal normal{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, {}};
  for (auto& m : normal.by_channel) m = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const double e = in.row(i)[0];
    const Eigen::Map<const Eigen::VectorXd> s(in.row(i) + 1, n);
    normal.u += e * s;
    normal.by_channel[in.of[i].channel].selfadjointView<Eigen::Lower>().rankUpdate(s);
    normal.squares += e * e;
  }
  for (auto& m : normal.by_channel) {
    m = Eigen::MatrixXd(m.selfadjointView<Eigen::Lower>());
    normal.F += m;
  }
  return normal;
}

// A mean that is off by its noise's scatter is inflated rather than believed: wider than five
// sigma happens once in a million rows by chance.
void inflate_outliers(const Innovations& in,
                      const std::vector<double>& weights,
                      std::vector<double>& inflation) {
  constexpr double kWide = 5.0;
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const auto channel = static_cast<Channel>(in.of[i].channel);
    if (channel == Channel::kWheelDistance || channel == Channel::kWheelHeading) continue;
    double e = 0.0;
    for (std::size_t k = 0; k < in.sides; ++k) e += weights[k] * in.row(i)[k];
    double& inflated = inflation[in.of[i].row];
    if (std::abs(e) > kWide) inflated *= std::abs(e) / 2.0;
  }
}

// Named effects held by their plausible sizes: what the noise may not swallow.
struct Saturated {
  Library library;
  Eigen::VectorXd precision;
};

Saturated saturated_library(const Observations& obs, const MotionPoint& point) {
  LibraryOptions options;
  options.places = false;
  options.grammar = false;
  Saturated s{build_library(obs, point, list_candidates(obs, point, options)), {}};
  s.precision.resize(static_cast<Eigen::Index>(s.library.candidates.size()));
  for (Eigen::Index i = 0; i < s.precision.size(); ++i) {
    const double tau = s.library.candidates[static_cast<std::size_t>(i)].tau;
    s.precision[i] = 1.0 / (tau * tau);
  }
  return s;
}

double largest_shift(const Elimination::Solution& solution) {
  double largest = 0.0;
  for (const auto& knot : solution.knots)
    largest = std::max({largest, std::abs(knot[kX]), std::abs(knot[kY])});
  return largest;
}

void renew_noise(const Observations& obs, MotionModel& model, const Saturated& s, bool outliers) {
  renew_residual(obs, model);
  const PassOptions options{true, kProbes, &model.inflation};
  const Pass pass = run_pass(obs, model.point, model.noise, s.library.columns, options);
  const Normal normal = normal_equations(pass.innovations, s.library.columns.count());
  Eigen::MatrixXd held = normal.F;
  held.diagonal() += s.precision;
  const Eigen::LDLT<Eigen::MatrixXd> solver(held);
  const Eigen::VectorXd size = solver.solve(normal.u);
  std::vector<double> weights(pass.innovations.sides, 0.0);
  weights[0] = 1.0;
  for (Eigen::Index k = 0; k < size.size(); ++k)
    weights[1 + static_cast<std::size_t>(k)] = -size[k];
  std::array<double, kChannels> fitted{};
  for (std::size_t c = 0; c < kChannels; ++c)
    fitted[c] = solver.solve(normal.by_channel[c]).trace();
  model.noise = renewed_noise(model.noise, pass, weights, kProbes, fitted);
  if (outliers) inflate_outliers(pass.innovations, weights, model.inflation);
  apply_solution(pass.elimination.back_substitute(weights), model.point.trajectory);
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

void fit_model(const Observations& obs, MotionModel& model, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    renew_residual(obs, model);
    const Columns columns = accepted_columns(obs, model);
    const Pass pass = run_pass(obs, model.point, model.noise, columns, {true, 0, &model.inflation});
    const Normal normal = normal_equations(pass.innovations, columns.count());
    // Exactly inseparable causes leave F singular: the least change among all equal ones.
    Eigen::MatrixXd held = normal.F;
    held.diagonal() *= 1.0 + 1e-10;
    const Eigen::VectorXd step = held.ldlt().solve(normal.u);
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
    model.log_likelihood = -0.5 * (normal.squares - (step.size() > 0 ? normal.u.dot(step) : 0.0));
    // A tenth of a standard deviation and a millimetre: the next step would change nothing.
    const double moved = step.size() > 0 ? step.dot(normal.F * step) : 0.0;
    if (moved < 0.01 && largest_shift(solution) < 1e-3) break;
  }
  renew_residual(obs, model);
}

double& size_of(MotionEffects& effects, const Candidate& named) {
  return motion_effects()[named.effect].size(effects);
}

MotionModel nominal_model(Observations& obs, const EffectSizes& known) {
  MotionModel model;
  for (const MotionEffect& effect : motion_effects())
    if (const auto size = known.find(std::string(effect.name)); size != known.end())
      effect.size(model.known) = size->second;
  model.point.effects = model.known;
  model.point.trajectory = trajectory_of_poses(obs);
  std::erase_if(obs.steering, [&](const WindowObservation& w) {
    const MotionState s = model.point.trajectory.at(0.5 * (w.begin_s + w.end_s));
    return std::abs(s.speed) < kMinSteeringSpeed;
  });
  model.inflation.assign(obs.offsets().back(), 1.0);
  const MotionNoise stated = stated_noise(obs);
  model.noise = stated;
  Saturated saturated;
  for (int i = 0; i < kNoiseIterations; ++i) {
    // The columns move little once the trajectory has been through one fit.
    if (i < 2) saturated = saturated_library(obs, model.point);
    renew_noise(obs, model, saturated, i >= kNoiseIterations / 2);
  }
  model.noise.gyro_rad_s = std::max(model.noise.gyro_rad_s, stated.gyro_rad_s);
  model.noise.steering_rad = std::max(model.noise.steering_rad, stated.steering_rad);
  model.noise = loosened(model.noise);
  fit_model(obs, model, 3);
  return model;
}

}  // namespace roadbook
