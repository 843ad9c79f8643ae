#include "diagnosis/views/view_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/index.hpp"
#include "base/median.hpp"
#include "diagnosis/numerics/student_noise.hpp"
#include "diagnosis/views/hinge_search.hpp"
#include "diagnosis/views/view_outliers.hpp"
#include "diagnosis/views/view_saturation.hpp"

namespace roadbook {
namespace {

constexpr double kFirstGate =
    8.0;  // [sigma] wide, because the nominal residuals still contain the effects

// A linearly independent subset of the effects; sums of others would be determined by their priors
// alone. Of the latencies, that of the first camera is left out and that of the wheels stays: poses
// then remain those of the image stamps, and hinges found at them fit the nominal ones. Height and
// slope of the ground stay instead of height and pitch of the first camera, for the same reason,
// and both components of an image centre instead of their sum.
std::vector<ViewCause> independent(std::vector<ViewCause> causes, const ViewBasis& basis) {
  const auto has = [&](const char* name) {
    return std::any_of(causes.begin(), causes.end(),
                       [&](const ViewCause& c) { return c.name == name; });
  };
  const bool wheels = has("wheels0.latency");
  const bool ground = basis.cameras > 1 && has("ground.slope");
  std::erase_if(causes, [&](const ViewCause& c) {
    return (basis.cameras > 1 && c.columns.size() > 1) || c.name == "wheels0.radius" ||
           c.name == "wheels0.radius_difference" || c.name.ends_with(".centre") ||
           (ground && c.columns.front() == basis.camera(0) + kHeightColumn) ||
           (ground && c.columns.front() == basis.camera(0) + kPitchColumn) ||
           (wheels && c.columns.front() == basis.camera(0) + kLatencyColumn);
  });
  return causes;
}

// Takes heights and lateral positions of cameras out of `causes`. A bend of the ground that is not
// yet fitted looks like a rig that is mounted decimetres farther back, with cameras at other
// heights. The car would then meet the line of the bend in another place, and stay there.
std::vector<ViewCause> held_until_bends_are_found(const ViewBasis& basis,
                                                  std::vector<ViewCause>& causes) {
  const auto is_held = [&](const ViewCause& c) {
    const std::size_t column = c.columns.front();
    return column < basis.wheels() && (column % basis.per_camera() == kHeightColumn ||
                                       column % basis.per_camera() == kLateralColumn);
  };
  std::vector<ViewCause> held;
  std::copy_if(causes.begin(), causes.end(), std::back_inserter(held), is_held);
  std::erase_if(causes, is_held);
  return held;
}

void forget_hinges(ViewBasis& basis, std::vector<ViewCause>& causes) {
  std::erase_if(causes, [](const ViewCause& cause) { return cause.name.empty(); });
  const std::size_t ground = basis.ground();
  for (ViewCause& cause : causes)
    for (std::size_t& column : cause.columns)
      if (column >= ground) column -= ground - basis.hinge();
  basis.hinges = 0;
}

// Replaces the hinges by those that the fit with all effects free shows. A line found beside large
// effects that are not yet fitted would be off by degrees.
void find_hinges(const ViewFit& fit,
                 ViewPoint& free,
                 ViewBasis& basis,
                 std::vector<ViewCause>& causes,
                 int num_threads) {
  forget_hinges(basis, causes);
  const std::size_t ground = basis.ground();
  find_hinge_lines(fit.data, fit.noise, num_threads, basis, free);
  for (ViewCause& cause : causes)
    for (std::size_t& column : cause.columns)
      if (column >= ground) column += basis.ground() - ground;
  for (std::size_t h = 0; h < basis.hinges; ++h)
    causes.push_back({"", "rad", kHingeTau, {basis.hinge(h)}});
}

// Counts on consistent landmarks only: on others it is unknown which views are wrong.
void count_outliers(const ViewData& all, const std::vector<std::uint8_t>& good, ViewFit& fit) {
  std::vector<int> balance(all.bundle.points.size(), 0);
  for (std::size_t o = 0; o < good.size(); ++o)
    balance[at(all.bundle.observations[o].point)] += good[o] != 0 ? 1 : -1;
  fit.views.assign(fit.noise.pixel.size(), 0);
  fit.outliers = fit.views;
  for (std::size_t o = 0; o < good.size(); ++o) {
    const BundleObservation& seen = all.bundle.observations[o];
    if (balance[at(seen.point)] < 3) continue;
    ++fit.views[at(seen.camera)];
    fit.outliers[at(seen.camera)] += good[o] != 0 ? 0 : 1;
  }
}

// Bundle adjustment with a robust loss; a first estimate of noise and outliers.
bool start(const ViewData& all,
           const ViewBasis& basis,
           int num_threads,
           ViewFit& fit,
           std::vector<std::uint8_t>& good) {
  BundleProblem problem = all.bundle;
  for (BundleObservation& o : problem.observations) o.sigma_px = fit.noise.pixel[at(o.camera)];
  fit.point.state = state_of(problem);
  ViewPrediction(all, basis).apply(fit.point, problem, num_threads);
  BundleOptions options;
  options.num_threads = num_threads;
  options.outlier_rounds = 0;
  options.max_iterations = 6;
  options.relative_tolerance = 1e-3;
  if (!bundle_adjust(problem, options).usable) return false;
  fit.point.state = state_of(problem);
  const std::vector<double> errors = view_errors_px(all, basis, fit.point, num_threads);
  std::vector<std::vector<double>> squares(problem.cameras.size());
  for (std::size_t o = 0; o < errors.size(); ++o)
    if (errors[o] >= 0.0)
      squares[at(problem.observations[o].camera)].push_back(errors[o] * errors[o]);
  for (std::size_t c = 0; c < squares.size(); ++c)
    if (!squares[c].empty())
      fit.noise.pixel[c] = std::max(0.02, std::sqrt(median(squares[c]) / kMedianOfTwoSquares));
  good = views_within(errors, all, kFirstGate, fit.noise.pixel);
  fit.data = kept_views(all, good);
  return true;
}

// Errors of all views with all effects free. Views in the fit have linearised errors. Views that
// were left out are predicted, because they may fit now.
std::vector<double> errors_left(const ViewData& all,
                                const ViewBasis& basis,
                                const ViewPoint& free,
                                const Saturated& s,
                                const ViewFit& fit,
                                const std::vector<std::uint8_t>& good,
                                int num_threads) {
  std::vector<double> errors = view_errors_px(all, basis, free, num_threads);
  std::size_t next = 0;
  for (std::size_t o = 0; o < errors.size(); ++o) {
    if (good[o] == 0) continue;
    const BundleObservation& seen = fit.data.bundle.observations[next];
    errors[o] = std::sqrt(s.view_square[next++]) * seen.sigma_px * fit.noise.pixel[at(seen.camera)];
  }
  return errors;
}

// Alternates estimates of noise, weights and outliers with all effects free, and finds hinges.
bool settle_noise(ViewData& all,
                  ViewBasis& basis,
                  const EffectSizes& known,
                  bool hinges,
                  int num_threads,
                  ViewFit& fit,
                  std::vector<std::uint8_t>& good) {
  std::vector<ViewCause> causes = independent(view_causes(all, basis), basis);
  const std::vector<ViewCause> held = held_until_bends_are_found(basis, causes);
  std::vector<double> scatter;
  std::vector<double> freedom;
  std::array<double, 6> sway{};
  ViewPoint free = fit.point;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0 && hinges) find_hinges(fit, free, basis, causes, num_threads);
    if (round + 1 == kRounds) causes.insert(causes.end(), held.begin(), held.end());
    ViewSystem system(fit.data, basis, num_threads);
    if (!system.linearise(free, fit.noise)) return false;
    const Saturated s = saturate(system, causes, basis, fit.data, known, free);
    const std::vector<double> errors = errors_left(all, basis, free, s, fit, good, num_threads);
    renew_noise(s, fit.data, fit.noise, freedom);
    scatter = s.scatter;
    sway = s.sway;
    good = weigh_views(errors, fit.noise.pixel, freedom, all);
    fit.data = kept_views(all, good);
  }
  fit.point.hinges = free.hinges;
  for (std::size_t c = 0; c < freedom.size(); ++c)
    fit.noise.pixel[c] *= std::sqrt(std::max(1.0, scatter[c] * student_excess(freedom[c])) *
                                    student_excess(freedom[c]));
  for (std::size_t axis = 0; axis < sway.size(); ++axis)
    fit.noise.motion[axis] *= std::sqrt(sway[axis]);
  return true;
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
  for (std::size_t k = 0; k < kRigColumns.size() && basis.cameras > 1; ++k) {
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < basis.cameras; ++c)
      columns.push_back(basis.camera(c) + kCameraColumns.size() + k);
    const std::string name = "rig." + std::string(kRigColumns[k]);
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
                   const Eigen::MatrixXd& sums,
                   const ViewPrior& elsewhere) {
  ViewStep step;
  const Eigen::Index n = sums.cols();
  step.size = Eigen::VectorXd::Zero(n);
  if (!system.linearise(point, noise, &sums)) return step;
  step.here = system.squares();
  const ViewSides sides = system.sides(sums);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(1 + n, 1 + n);
  system.each_pose(sides, [&](std::size_t, const ViewPanel& values) {
    G.noalias() += values.transpose() * values;
  });
  step.information = G.bottomRightCorner(n, n);
  if (n > 0) {
    Eigen::MatrixXd F = step.information;
    F.diagonal() *= 1.0 + 1e-10;
    Eigen::VectorXd score = G.col(0).tail(n);
    if (elsewhere.score.size() > 0) {
      F += elsewhere.information;
      score += elsewhere.score;
    }
    step.size = F.ldlt().solve(score);
  }
  step.squares = G(0, 0) - step.size.dot(2.0 * G.col(0).tail(n) - step.information * step.size);
  system.move(point, sides, step.size);
  return step;
}

void settle(ViewSystem& system, const ViewNoise& noise, ViewPoint& point) {
  const Eigen::MatrixXd none(point.linear.size(), 0);
  for (int i = 0; i < 2; ++i) {
    const ViewPoint from = point;
    const double here = view_step(system, point, noise, none).here;
    if (system.settle_points(point) <= kNoRise * here) continue;
    point = from;
    static_cast<void>(system.adjust(point, noise));
    return;
  }
}

ViewFit fit_views(
    ViewData all, ViewBasis& basis, const EffectSizes& known, bool hinges, int num_threads) {
  ViewFit fit;
  const std::size_t cameras = all.bundle.cameras.size();
  fit.noise.pixel.assign(cameras, 1.0);
  fit.point.effects = known;
  fit.point.linear = Eigen::VectorXd::Zero(index(basis.size()));
  std::vector<std::uint8_t> good;  // 1: the view is in fit.data
  if (!start(all, basis, num_threads, fit, good)) {
    fit.message = "the bundle adjustment of the camera observations does not converge";
    return fit;
  }
  if (!settle_noise(all, basis, known, hinges && all.has_wheels, num_threads, fit, good)) {
    fit.message = "the camera observations do not determine the relative poses";
    return fit;
  }
  count_outliers(all, good, fit);
  fit.point.linear = Eigen::VectorXd::Zero(index(basis.size()));
  // A model stores no line of a hinge, so the best line of this drive is used.
  if (basis.hinges > 0)
    fit.point.linear[index(basis.hinge())] = effect_size(known, "ground", "hinge");
  ViewSystem system(fit.data, basis, num_threads);
  settle(system, fit.noise, fit.point);
  fit.usable = true;
  return fit;
}

}  // namespace roadbook
