#include "mapping/optimisation/bundle_adjustment.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/parallel.hpp"
#include "mapping/optimisation/bundle_adjustment_ceres.hpp"
#include "mapping/optimisation/bundle_adjustment_check.hpp"
#include "mapping/optimisation/bundle_adjustment_system.hpp"
#include "mapping/optimisation/bundle_adjustment_terms.hpp"

namespace roadbook {
namespace {

// Levenberg-Marquardt with Nielsen's rule for the damping (Madsen, Nielsen, Tingleff 2004, 3.16).
BundleMinimum minimise_by_own_solver(const BundleProblem& problem,
                                     const BundleLayout& layout,
                                     const BundleOptions& options,
                                     BundleState& state,
                                     const Progress& progress) {
  BundleSystem system(problem, layout, options);
  BundleMinimum minimum;
  double cost = bundle_cost(problem, layout, state, options);
  minimum.initial_cost = cost;
  double lambda = 1e-4;
  double growth = 2.0;
  bool fresh = false;
  BundleStep step;
  while (minimum.iterations < options.max_iterations && !minimum.converged) {
    report(progress, "bundle adjustment", at(minimum.iterations), at(options.max_iterations));
    ++minimum.iterations;
    if (!fresh) system.linearise(state);
    fresh = true;
    const bool solved = system.solve(lambda, step);
    double gain = -1.0;
    if (solved && step.model_decrease <= 1e-14 * cost) {
      minimum.converged = true;
      break;
    }
    if (solved) {
      BundleState next = moved(state, layout, step);
      const double next_cost = bundle_cost(problem, layout, next, options);
      gain = (cost - next_cost) / step.model_decrease;
      if (gain > 0.0) {
        minimum.converged = cost - next_cost < options.relative_tolerance * cost;
        cost = next_cost;
        state = std::move(next);
        fresh = false;
      } else {
        // Neither the model nor the cost sees a gain that would count.
        minimum.converged = step.model_decrease < options.relative_tolerance * cost;
      }
    }
    if (gain > 0.0) {
      lambda = std::max(1e-12, lambda * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3)));
      growth = 2.0;
    } else {
      lambda *= growth;
      growth *= 2.0;
      if (lambda > 1e12) break;
    }
  }
  minimum.final_cost = cost;
  return minimum;
}

// Squared whitened residual of every observation, negative where the camera cannot see the point.
std::vector<double> observation_chi2(const BundleProblem& problem,
                                     const BundleState& state,
                                     const BundleOptions& options) {
  std::vector<double> chi2(problem.observations.size());
  constexpr std::size_t kChunk = 1024;
  parallel_for((chi2.size() + kChunk - 1) / kChunk, options.num_threads, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(chi2.size(), (chunk + 1) * kChunk); ++i) {
      const BundleObservation& o = problem.observations[i];
      const BundleTerm term{o.pose, o.camera, -1, o.pixel, 1.0 / o.sigma_px};
      const TermResidual e =
          term_residual(problem, term, state.poses[at(o.pose)], state.points[at(o.point)], false);
      chi2[i] = e.valid ? e.r.squaredNorm() : -1.0;
    }
  });
  return chi2;
}

// A point that moves needs two observations.
void drop_lonely_points(const BundleProblem& problem, BundleResult& result) {
  std::vector<int> count(problem.points.size(), 0);
  for (std::size_t o = 0; o < problem.observations.size(); ++o)
    if (result.inlier[o] != 0) ++count[at(problem.observations[o].point)];
  for (std::size_t p = 0; p < problem.points.size(); ++p)
    result.point_kept[p] = problem.points[p].fixed || count[p] >= 2;
  for (std::size_t o = 0; o < problem.observations.size(); ++o)
    if (result.point_kept[at(problem.observations[o].point)] == 0) result.inlier[o] = 0;
}

// Returns whether anything changed. An observation once removed comes back if it fits again.
bool select_inliers(const BundleProblem& problem,
                    const std::vector<double>& chi2,
                    double max_chi2,
                    BundleResult& result) {
  const std::vector<std::uint8_t> before = result.inlier;
  for (std::size_t o = 0; o < chi2.size(); ++o)
    result.inlier[o] = chi2[o] >= 0.0 && chi2[o] <= max_chi2;
  drop_lonely_points(problem, result);
  return before != result.inlier;
}

void add_statistics(const BundleProblem& problem,
                    const std::vector<double>& chi2,
                    const BundleLayout& layout,
                    BundleResult& result) {
  std::vector<double> errors;
  double sum = 0.0;
  for (std::size_t o = 0; o < chi2.size(); ++o) {
    if (result.inlier[o] == 0) continue;
    errors.push_back(std::sqrt(std::max(chi2[o], 0.0)) * problem.observations[o].sigma_px);
    sum += errors.back() * errors.back();
  }
  if (errors.empty()) return;
  result.reprojection_rms_px = std::sqrt(sum / (2.0 * static_cast<double>(errors.size())));
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  result.reprojection_median_px = *middle;
  std::size_t parameters = 6 * layout.pose_of.size();
  for (const auto free : layout.point_free) parameters += free != 0 ? 3 : 0;
  const std::size_t values = 2 * errors.size();
  result.degrees_of_freedom = values > parameters ? values - parameters : 0;
}

bool finite(const BundleState& state) {
  const auto good = [](const auto& list, auto test) {
    return std::all_of(list.begin(), list.end(), test);
  };
  return good(state.poses, [](const auto& T) { return T.matrix().allFinite(); }) &&
         good(state.points, [](const auto& p) { return p.allFinite(); }) &&
         good(state.scales, [](double s) { return std::isfinite(s); });
}

void store(const BundleState& state, BundleProblem& problem) {
  for (std::size_t i = 0; i < problem.poses.size(); ++i)
    problem.poses[i].T_map_vehicle = state.poses[i];
  for (std::size_t i = 0; i < problem.points.size(); ++i) problem.points[i].p_map = state.points[i];
  for (std::size_t i = 0; i < problem.scales.size(); ++i) problem.scales[i].value = state.scales[i];
}

}  // namespace

BundleResult bundle_adjust(BundleProblem& problem,
                           const BundleOptions& options,
                           const Progress& progress) {
  options.check();
  check_bundle(problem);
  BundleResult result;
  result.inlier.assign(problem.observations.size(), 1);
  result.point_kept.assign(problem.points.size(), 1);
  drop_lonely_points(problem, result);
  BundleState state = state_of(problem);
  std::vector<double> chi2;
  for (int round = 0;; ++round) {
    const BundleLayout layout(problem, options, result.inlier, result.point_kept);
    const BundleMinimum minimum =
        options.solver == LeastSquaresSolver::kCeres
            ? minimise_by_ceres(problem, layout, options, state, progress)
            : minimise_by_own_solver(problem, layout, options, state, progress);
    if (round == 0) result.initial_cost = minimum.initial_cost;
    result.final_cost = minimum.final_cost;
    result.iterations += minimum.iterations;
    result.converged = minimum.converged;
    result.usable = finite(state) && minimum.final_cost <= minimum.initial_cost;
    if (!result.usable) break;
    chi2 = observation_chi2(problem, state, options);
    const bool changed =
        options.outlier_rounds > 0 && select_inliers(problem, chi2, options.max_chi2, result);
    if (changed && round < options.outlier_rounds) continue;
    const BundleLayout last(problem, options, result.inlier, result.point_kept);
    if (changed) result.final_cost = bundle_cost(problem, last, state, options);
    add_statistics(problem, chi2, last, result);
    break;
  }
  if (!result.usable) {
    result.message = "not finite or diverged: problem left as it was";
    return result;
  }
  result.message = result.converged ? "converged" : "stopped after max_iterations";
  store(state, problem);
  return result;
}

}  // namespace roadbook
