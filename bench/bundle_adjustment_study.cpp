#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "mapping/optimisation/covariance.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

// Time of bundle adjustment by roadbook's own solver and by Ceres, and of the covariances, on a
// synthetic car park and on the window of a visual odometry. Four fisheyes, a pose every 40 cm or
// 2 m. Both solvers run on one thread, in turn, from the same start to the same tolerance; the
// median of three runs counts. The own solver is also timed on all cores.
namespace {

using roadbook::BundleOptions;
using roadbook::BundleResult;
using roadbook::LeastSquaresSolver;
using roadbook::test::SyntheticBundle;

constexpr int kRuns = 3;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

struct Timed {
  std::vector<double> seconds;
  BundleResult result;

  void run(const SyntheticBundle& start, const BundleOptions& options) {
    roadbook::BundleProblem problem = start.problem;
    const auto begin = std::chrono::steady_clock::now();
    result = roadbook::bundle_adjust(problem, options);
    seconds.push_back(seconds_since(begin));
  }
  [[nodiscard]] double median() {
    std::sort(seconds.begin(), seconds.end());
    return seconds[seconds.size() / 2];
  }
};

void print(const char* solver, Timed& timed) {
  std::printf("  %-24s %8.3f s, %2d iterations, cost %.8e, rms %.3f px\n", solver, timed.median(),
              timed.result.iterations, timed.result.final_cost, timed.result.reprojection_rms_px);
}

void compare(const char* name, const roadbook::test::SyntheticOptions& options) {
  SyntheticBundle made = roadbook::test::synthetic_bundle(options, 1);
  std::printf("%s: %zu poses, %zu points, %zu observations\n", name, made.poses.size(),
              made.points.size(), made.problem.observations.size());
  BundleOptions bundle{.max_iterations = 100, .relative_tolerance = 1e-9, .num_threads = 1};
  BundleOptions ceres = bundle;
  ceres.solver = LeastSquaresSolver::kCeres;
  BundleOptions all_cores = bundle;
  all_cores.num_threads = 0;
  Timed by_own, by_ceres, by_own_on_all_cores;
  for (int run = 0; run < kRuns; ++run) {
    by_own.run(made, bundle);
    by_ceres.run(made, ceres);
    by_own_on_all_cores.run(made, all_cores);
  }
  print("own, one thread", by_own);
  print("own, all cores", by_own_on_all_cores);
  print("Ceres, one thread", by_ceres);
  std::printf("  own / Ceres: time %.2f, cost %.9f\n", by_own.median() / by_ceres.median(),
              by_own.result.final_cost / by_ceres.result.final_cost);
  (void)roadbook::bundle_adjust(made.problem, bundle);
  const auto begin = std::chrono::steady_clock::now();
  const auto covariance = roadbook::bundle_covariance(made.problem, by_own.result.inlier, bundle);
  std::printf("  covariances, one thread: %.3f s%s\n", seconds_since(begin),
              covariance.usable ? "" : " (singular)");
}

}  // namespace

int main() {
  compare("car park",
          {.length_m = 60.0, .spacing_m = 0.4, .point_count = 8000, .reach_m = 3.0, .laps = 2.0});
  compare("window", {.length_m = 20.0, .spacing_m = 2.0, .point_count = 60});
}
