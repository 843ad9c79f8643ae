#include "diagnosis/range/beacon_problem.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/inference/linear_fit.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/numerics/outlier_mixture.hpp"
#include "sensors/effects.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

double value_of(const BeaconRange& r, const std::string& covariate, double start_s) {
  if (covariate == "range") return r.expected_m;
  if (covariate == "bearing") return r.bearing;
  if (covariate == "heading") return r.heading;
  return r.t_s - start_s;
}

bool is_angle(const std::string& covariate) {
  return covariate == "bearing" || covariate == "heading";
}

}  // namespace

BeaconReadings beacon_readings(std::vector<BeaconRange> samples) {
  BeaconReadings readings;
  if (samples.size() < 50) {
    readings.notes.push_back("ranges to beacons not diagnosed: " + std::to_string(samples.size()) +
                             " ranges with a reference pose, want at least 50");
    return readings;
  }
  readings.samples = std::move(samples);
  return readings;
}

BeaconProblem::BeaconProblem(BeaconReadings readings, LibraryOptions library)
    : readings_(std::move(readings)), library_(std::move(library)) {
  constexpr double kGap = 10.0;  // [s]
  std::map<int, std::size_t> last;
  for (std::size_t i = 0; i < readings_.samples.size(); ++i) {
    const BeaconRange& r = readings_.samples[i];
    const auto at = last.find(r.beacon);
    const bool goes_on = at != last.end() && r.t_s - readings_.samples[at->second].t_s < kGap;
    before_.push_back(goes_on ? at->second : i);
    last[r.beacon] = i;
  }
  for (const auto& [beacon, i] : last) beacons_.push_back(beacon);
  estimate_noise();
}

std::vector<ChannelName> BeaconProblem::channels() const { return {{"range0", "beacon range"}}; }

// Estimates with bias, scale and a bias of each beacon free; the second round knows the outliers.
void BeaconProblem::estimate_noise() {
  const auto n = static_cast<Index>(rows());
  Eigen::MatrixXd X(n, 1 + static_cast<Index>(beacons_.size()));
  Eigen::VectorXd y(n);
  for (Index i = 0; i < n; ++i) {
    const BeaconRange& r = readings_.samples[static_cast<std::size_t>(i)];
    y[i] = r.read_m - r.expected_m;
    X(i, 0) = r.expected_m;
    for (std::size_t b = 0; b < beacons_.size(); ++b)
      X(i, static_cast<Index>(b) + 1) = r.beacon == beacons_[b];
  }
  noise_.weight.assign(rows(), 1.0);
  std::vector<double> z(rows());
  for (int iteration = 0; iteration < 8; ++iteration) {
    const Eigen::VectorXd w =
        Eigen::Map<const Eigen::VectorXd>(noise_.weight.data(), n).cwiseAbs2();
    Eigen::MatrixXd F = X.transpose() * w.asDiagonal() * X;
    F.diagonal() *= 1.0 + 1e-9;
    const Eigen::VectorXd left = y - X * F.ldlt().solve(X.transpose() * w.asDiagonal() * y);
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = left[static_cast<Index>(i)];
    const OutlierMixture m = fit_outliers(z);
    const bool mixed = 2.0 * m.gained > 20.0 && m.share > 0.002;
    noise_.sigma_m = mixed ? m.scale : m.alone;
    noise_.outliers = mixed ? m.share : 0.0;
    noise_.outliers_sigma = m.share_sigma;
    noise_.outliers_z = std::sqrt(2.0 * std::max(m.gained, 0.0));
    for (std::size_t i = 0; i < z.size(); ++i)
      noise_.weight[i] =
          std::sqrt(mixed ? 1.0 - m.part[i] + 0.01 * m.part[i] : 1.0) / noise_.sigma_m;
  }
  double products = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const std::size_t b = before_[i];
    if (b == i) continue;
    const double now = z[i] * noise_.weight[i], last = z[b] * noise_.weight[b];
    products += now * last;
    squares += 0.5 * (now * now + last * last);
    noise_.pairs += 1.0;
  }
  if (noise_.pairs > 30.0) noise_.correlation = std::clamp(products / squares, -0.95, 0.95);
  if (std::abs(noise_.correlation) * std::sqrt(noise_.pairs) < 4.5) noise_.correlation = 0.0;
}

Innovations BeaconProblem::whitened(const Eigen::MatrixXd& sides) const {
  Innovations result;
  result.sides = static_cast<std::size_t>(sides.cols());
  const double fresh = std::sqrt(1.0 - noise_.correlation * noise_.correlation);
  for (std::size_t i = 0; i < rows(); ++i) {
    Eigen::RowVectorXd row = noise_.weight[i] * sides.row(static_cast<Index>(i));
    const std::size_t b = before_[i];
    if (b != i && noise_.correlation != 0.0)
      row =
          (row - noise_.correlation * noise_.weight[b] * sides.row(static_cast<Index>(b))) / fresh;
    result.of.push_back({i, 0, readings_.samples[i].t_s, 1.0});
    result.values.insert(result.values.end(), row.data(), row.data() + row.size());
  }
  return result;
}

CauseModel BeaconProblem::nominal() const {
  CauseModel model;
  model.state = std::make_shared<CauseState>();
  fit(model, 1);
  return model;
}

std::vector<Candidate> BeaconProblem::candidates(const CauseModel& /*model*/) const {
  std::vector<Candidate> all;
  for (const EffectInfo& e : reading_effects()) {
    if (e.name != "range0.bias" && e.name != "range0.scale") continue;
    Candidate c;
    c.name = e.name;
    c.unit = e.unit;
    c.tau = e.plausible;
    if (library_.named) all.push_back(c);
  }
  for (const char* covariate : {"range", "time", "bearing", "heading", "beacon"}) {
    Candidate c;
    c.kind = CandidateKind::kGrammar;
    c.hook = "range0.beacon_range";
    c.covariate = covariate;
    c.name = c.hook + " ~ " + c.covariate;
    c.unit = "m";
    c.tau = 0.3;
    c.penalty = 2.0;
    if (library_.grammar) all.push_back(c);
  }
  std::erase_if(all, [&](const Candidate& c) {
    return std::find(library_.without.begin(), library_.without.end(), c.name) !=
           library_.without.end();
  });
  return all;
}

Eigen::MatrixXd BeaconProblem::columns(const Candidate& candidate) const {
  const auto n = static_cast<Index>(rows());
  const auto& samples = readings_.samples;
  const auto at = [&](Index i) -> const BeaconRange& {
    return samples[static_cast<std::size_t>(i)];
  };
  if (candidate.name == "range0.bias") return Eigen::MatrixXd::Ones(n, 1);
  Eigen::MatrixXd X;
  if (candidate.name == "range0.scale") {
    X.resize(n, 1);
    for (Index i = 0; i < n; ++i) X(i, 0) = at(i).expected_m;
    return X;
  }
  if (candidate.covariate == "beacon") {
    X.resize(n, static_cast<Index>(beacons_.size()));
    for (Index i = 0; i < n; ++i)
      for (std::size_t b = 0; b < beacons_.size(); ++b)
        X(i, static_cast<Index>(b)) = at(i).beacon == beacons_[b];
    return X;
  }
  X.resize(n, 2);
  double mean = 0.0, square = 0.0;
  for (Index i = 0; i < n; ++i) {
    const double v = value_of(at(i), candidate.covariate, samples.front().t_s);
    mean += v / static_cast<double>(n);
    square += v * v / static_cast<double>(n);
  }
  const double sd = std::sqrt(std::max(square - mean * mean, 1e-12));
  for (Index i = 0; i < n; ++i) {
    const double v = value_of(at(i), candidate.covariate, samples.front().t_s);
    const double u = (v - mean) / sd;
    X.row(i) = is_angle(candidate.covariate) ? Eigen::RowVector2d(std::cos(v), std::sin(v))
                                             : Eigen::RowVector2d(u, u * u - 1.0);
  }
  return X;
}

Projection BeaconProblem::project(const CauseModel& model,
                                  std::vector<Candidate> candidates) const {
  Eigen::VectorXd residual(static_cast<Index>(rows()));
  for (std::size_t i = 0; i < rows(); ++i)
    residual[static_cast<Index>(i)] = readings_.samples[i].read_m - readings_.samples[i].expected_m;
  return linear_projection(
      model, std::move(candidates), std::move(residual),
      [&](const Candidate& c) { return columns(c); },
      [&](const Eigen::MatrixXd& sides) { return whitened(sides); });
}

void BeaconProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void BeaconProblem::fit_beside(CauseModel& model,
                               int /*iterations*/,
                               const SizePrior& others) const {
  linear_fit(project(model, {}), model, others);
}

std::vector<NoiseCause> BeaconProblem::noise_causes(const CauseModel& /*model*/) const {
  std::vector<NoiseCause> causes;
  const auto p = [](double z) { return std::min(1.0, 2.0 * chi_squared_tail(z * z, 1)); };
  if (noise_.outliers > 0.0)
    causes.push_back({"range0.outliers", "1", noise_.outliers, noise_.outliers_sigma,
                      noise_.outliers_z, p(noise_.outliers_z)});
  if (noise_.correlation != 0.0) {
    const double sigma = std::sqrt((1.0 - noise_.correlation * noise_.correlation) / noise_.pairs);
    causes.push_back({"range0.correlation", "1", noise_.correlation, sigma,
                      noise_.correlation / sigma, p(noise_.correlation / sigma)});
  }
  return causes;
}

RowCovariate BeaconProblem::covariate(const CauseModel& /*model*/,
                                      const Candidate& cause,
                                      const Innovations& innovations) const {
  RowCovariate result{"range [m]", {}};
  const bool named = cause.kind == CandidateKind::kNamed;
  if (!named) result.axis = cause.covariate;
  for (const Innovation& i : innovations.of) {
    const BeaconRange& r = readings_.samples[i.row];
    result.values.push_back(
        cause.covariate == "beacon"
            ? r.beacon
            : value_of(r, named ? "range" : cause.covariate, readings_.samples.front().t_s));
  }
  return result;
}

}  // namespace roadbook
