#include "diagnosis/view_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/track_correlation.hpp"

namespace roadbook {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

constexpr double kFirstGate = 8.0;  // [sigma] by the nominal fit, generous: causes are in there too
constexpr double kGate = 4.0;       // [sigma] with all named effects free
constexpr std::size_t kProbes = 4;
constexpr double kMedianOfSquare = 0.4549;      // of a standard normal
constexpr double kMedianOfTwoSquares = 1.3863;  // chi-squared of two degrees of freedom

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::MatrixXd sums_of(const std::vector<ViewCause>& causes, std::size_t basis) {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(index(basis), index(causes.size()));
  for (std::size_t c = 0; c < causes.size(); ++c)
    for (const std::size_t column : causes[c].columns) sums(index(column), index(c)) = 1.0;
  return sums;
}

// The data with the observations marked, in order.
ViewData kept(const ViewData& data, const std::vector<std::uint8_t>& good) {
  ViewData some = data;
  some.bundle.observations.clear();
  for (std::size_t o = 0; o < good.size(); ++o)
    if (good[o] != 0) some.bundle.observations.push_back(data.bundle.observations[o]);
  return some;
}

// Distance of every observation from where the point predicts it [px]; negative where it cannot.
std::vector<double> errors_px(const ViewData& data,
                              const ViewBasis& basis,
                              const ViewPoint& point) {
  BundleProblem problem = data.bundle;
  ViewPrediction(data, basis).apply(point, problem);
  std::vector<double> errors;
  for (const BundleObservation& o : problem.observations) {
    const BundleTerm term{o.pose, o.camera, -1, o.pixel, 1.0};
    const TermResidual e = term_residual(problem, term, point.state.poses[at(o.pose)],
                                         point.state.points[at(o.point)], false);
    errors.push_back(e.valid ? e.r.norm() : -1.0);
  }
  return errors;
}

std::vector<std::uint8_t> within(const std::vector<double>& errors,
                                 const ViewData& data,
                                 double gate,
                                 const std::vector<double>& sigma_px) {
  std::vector<std::uint8_t> good(errors.size());
  for (std::size_t o = 0; o < errors.size(); ++o)
    good[o] =
        errors[o] >= 0.0 && errors[o] < gate * sigma_px[at(data.bundle.observations[o].camera)];
  return good;
}

// Poses and landmarks under a robust loss, and the first rough noise and outliers.
bool start(const ViewData& all, const ViewBasis& basis, ViewFit& fit) {
  BundleProblem problem = all.bundle;
  for (BundleObservation& o : problem.observations) o.sigma_px = fit.noise.pixel[at(o.camera)];
  fit.point.state = state_of(problem);
  ViewPrediction(all, basis).apply(fit.point, problem);
  BundleOptions options;
  options.num_threads = 1;
  options.outlier_rounds = 0;
  options.max_iterations = 6;
  options.relative_tolerance = 1e-3;
  if (!bundle_adjust(problem, options).usable) return false;
  fit.point.state = state_of(problem);
  const std::vector<double> errors = errors_px(all, basis, fit.point);
  std::vector<std::vector<double>> squares(problem.cameras.size());
  for (std::size_t o = 0; o < errors.size(); ++o)
    if (errors[o] >= 0.0)
      squares[at(problem.observations[o].camera)].push_back(errors[o] * errors[o]);
  for (std::size_t c = 0; c < squares.size(); ++c)
    if (!squares[c].empty())
      fit.noise.pixel[c] = std::max(0.02, std::sqrt(median(squares[c]) / kMedianOfTwoSquares));
  fit.data = kept(all, within(errors, all, kFirstGate, fit.noise.pixel));
  return true;
}

// What the rows leave once all named effects are fitted, and how much of each channel's noise that
// is.
struct Saturated {
  std::vector<std::vector<double>> squares;  ///< of each channel's rows
  std::vector<double> redundancy;            ///< sums over each channel's rows
  std::vector<double> inflation;             ///< of each camera, see `correlation_inflation`
};

Saturated saturate(const ViewSystem& system,
                   const std::vector<ViewCause>& causes,
                   std::size_t basis,
                   const ViewChannels& channels,
                   const ViewData& data,
                   ViewPoint& point) {
  const auto n = index(causes.size());
  const ViewSides sides = system.sides(sums_of(causes, basis), kProbes);
  ROADBOOK_ASSERT(sides.count == 1 + n + index(kProbes));
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(1 + n, 1 + n);
  ViewPanel values;
  std::vector<ViewPanel> all(system.poses());
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, all[k]);
    F.noalias() += all[k].leftCols(1 + n).transpose() * all[k].leftCols(1 + n);
  }
  for (Eigen::Index c = 0; c < n; ++c)
    F(1 + c, 1 + c) +=
        1.0 / (causes[at(static_cast<int>(c))].tau * causes[at(static_cast<int>(c))].tau);
  const Eigen::VectorXd size = F.bottomRightCorner(n, n).ldlt().solve(F.col(0).tail(n));
  system.move(point, sides, size);
  for (Eigen::Index c = 0; c < n; ++c)
    point.effects[causes[static_cast<std::size_t>(c)].name] += size[c];
  Saturated s;
  s.squares.resize(channels.size());
  s.redundancy.assign(channels.size(), 0.0);
  TrackCorrelation tracks(data);
  ViewPanel signs;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, signs, true);
    const Eigen::VectorXd left = all[k].col(0) - all[k].middleCols(1, n) * size;
    const auto& info = system.row_info(k);
    for (std::size_t i = 0; i < info.size(); ++i) {
      const double square = left[index(i)] * left[index(i)];
      s.squares[info[i].channel].push_back(square);
      if (info[i].observation >= 0) {
        const bool second = i > 0 && info[i - 1].observation == info[i].observation;
        tracks.add(at(info[i].observation), second, left[index(i)], all[k](index(i), 1 + n));
      }
      s.redundancy[info[i].channel] +=
          signs.row(index(i)).tail(index(kProbes)).dot(all[k].row(index(i)).tail(index(kProbes))) /
          static_cast<double>(kProbes);
    }
  }
  s.inflation = tracks.inflation();
  return s;
}

// Standard deviation of a channel's readings in units of what was assumed: of motions by the
// median, which a bump in the road does not move.
double scale_of(const Saturated& s, std::size_t channel, bool by_median) {
  const auto& squares = s.squares[channel];
  if (squares.empty()) return 1.0;
  const double share = s.redundancy[channel] / static_cast<double>(squares.size());
  if (share < 0.02) return 1.0;  // nothing else knows what these rows read
  if (by_median) return std::sqrt(median(squares) / kMedianOfSquare / share);
  // Mean without what lies beyond the gate, by three rounds.
  double variance = median(squares) / kMedianOfSquare;
  for (int round = 0; round < 3; ++round) {
    double sum = 0.0;
    double count = 0.0;
    for (const double q : squares)
      if (q < kGate * kGate * variance) {
        sum += q;
        count += 1.0;
      }
    variance = sum / std::max(1.0, count);
  }
  return std::sqrt(variance / share);
}

void renew_noise(const Saturated& s, const ViewChannels& channels, ViewNoise& noise) {
  const auto scale = [&](std::size_t channel, bool by_median) {
    return std::clamp(scale_of(s, channel, by_median), 0.05, 20.0);
  };
  for (std::size_t c = 0; c < channels.cameras; ++c)
    noise.pixel[c] = std::max(0.01, noise.pixel[c] * scale(c, false));
  for (std::size_t axis = 0; axis < 6; ++axis)
    noise.motion[axis] =
        std::clamp(noise.motion[axis] * scale(channels.motion(axis), true), 0.01, 20.0);
  noise.ground_m = std::max(5e-4, noise.ground_m * scale(channels.ground(), true));
}

}  // namespace

std::vector<ViewCause> view_causes(const ViewData& data, const ViewBasis& basis) {
  std::vector<ViewCause> causes;
  const auto add = [&](const std::string& name, const std::string& declared,
                       std::vector<std::size_t> columns) {
    for (const EffectInfo& info : all_effects())
      if (info.name == declared)
        causes.push_back({name, std::string(info.unit), info.plausible, std::move(columns)});
  };
  for (std::size_t c = 0; c < basis.cameras; ++c)
    for (std::size_t k = 0; k < kCameraColumns.size(); ++k)
      add(data.bundle.cameras[c].name + "." + std::string(kCameraColumns[k]),
          "cam." + std::string(kCameraColumns[k]), {basis.camera(c) + k});
  for (std::size_t k = 0; k < kCameraColumns.size() && basis.cameras > 1; ++k) {
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < basis.cameras; ++c) columns.push_back(basis.camera(c) + k);
    const std::string name = "cam." + std::string(kCameraColumns[k]);
    add(name, name, columns);
  }
  for (std::size_t k = 0; k < kWheelColumns.size() && data.has_wheels; ++k) {
    const std::string name = "wheels0." + std::string(kWheelColumns[k]);
    add(name, name, {basis.wheels() + k});
  }
  const bool ground = std::any_of(data.bundle.points.begin(), data.bundle.points.end(),
                                  [](const BundlePoint& p) { return p.ground; });
  for (std::size_t k = 0; k < kGroundColumns.size() && ground; ++k) {
    const std::string name = "ground." + std::string(kGroundColumns[k]);
    add(name, name, {basis.ground() + k});
  }
  return causes;
}

ViewStep view_step(ViewSystem& system,
                   ViewPoint& point,
                   const ViewNoise& noise,
                   const Eigen::MatrixXd& sums) {
  ViewStep step;
  const Eigen::Index n = sums.cols();
  step.size = Eigen::VectorXd::Zero(n);
  if (!system.linearise(point, noise)) return step;
  const ViewSides sides = system.sides(sums);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(1 + n, 1 + n);
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, values);
    G.noalias() += values.transpose() * values;
  }
  step.information = G.bottomRightCorner(n, n);
  step.before = G(0, 0);
  if (n > 0) {
    Eigen::MatrixXd F = step.information;
    F.diagonal() *= 1.0 + 1e-10;
    step.size = F.ldlt().solve(G.col(0).tail(n));
  }
  step.squares = G(0, 0) - step.size.dot(G.col(0).tail(n));
  system.move(point, sides, step.size);
  return step;
}

ViewFit fit_views(ViewData all, const ViewBasis& basis, const EffectSizes& known) {
  ViewFit fit;
  const ViewChannels channels{all.bundle.cameras.size()};
  fit.noise.pixel.assign(channels.cameras, 1.0);
  fit.point.effects = known;
  fit.point.linear = Eigen::VectorXd::Zero(index(basis.size()));
  fit.views.assign(channels.cameras, 0);
  for (const BundleObservation& o : all.bundle.observations) ++fit.views[at(o.camera)];
  if (!start(all, basis, fit)) {
    fit.message = "bundle adjustment of the map's views does not converge";
    return fit;
  }
  const auto causes = view_causes(all, basis);
  std::vector<double> inflation;
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    ViewSystem system(fit.data, basis);
    if (!system.linearise(fit.point, fit.noise)) {
      fit.message = "the views do not hold the poses together";
      return fit;
    }
    ViewPoint free = fit.point;  // with all named effects free
    const Saturated s = saturate(system, causes, basis.size(), channels, fit.data, free);
    renew_noise(s, channels, fit.noise);
    inflation = s.inflation;
    // Also those that fitted badly without the effects.
    fit.data = kept(all, within(errors_px(all, basis, free), all, kGate, fit.noise.pixel));
  }
  fit.outliers = fit.views;
  for (const BundleObservation& o : fit.data.bundle.observations) --fit.outliers[at(o.camera)];
  for (std::size_t c = 0; c < channels.cameras; ++c) fit.noise.pixel[c] *= inflation[c];
  ViewSystem system(fit.data, basis);
  for (int i = 0; i < 2; ++i)
    static_cast<void>(
        view_step(system, fit.point, fit.noise, Eigen::MatrixXd(index(basis.size()), 0)));
  fit.usable = true;
  return fit;
}

}  // namespace roadbook
