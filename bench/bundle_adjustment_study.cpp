#include <chrono>
#include <cstdio>

#include "mapping/optimisation/covariance.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

// Time of bundle adjustment and covariances on a synthetic car park of full size (two laps, poses
// every 20 cm, four fisheyes), and on the window of a visual odometry.
namespace {

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void adjust(const char* name, const roadbook::test::SyntheticOptions& options, int num_threads) {
  using Clock = std::chrono::steady_clock;
  auto made = roadbook::test::synthetic_bundle(options, 1);
  const roadbook::BundleOptions bundle{.num_threads = num_threads};
  auto begin = Clock::now();
  const auto result = roadbook::bundle_adjust(made.problem, bundle);
  std::printf("%s: %zu poses, %zu points, %zu observations: %.3f s, %d iterations, rms %.3f px\n",
              name, made.poses.size(), made.points.size(), made.problem.observations.size(),
              seconds_since(begin), result.iterations, result.reprojection_rms_px);
  begin = Clock::now();
  const auto covariance = roadbook::bundle_covariance(made.problem, result.inlier, bundle);
  std::printf("  covariances: %.3f s%s\n", seconds_since(begin),
              covariance.usable ? "" : " (singular)");
}

}  // namespace

int main() {
  adjust("car park",
         {.length_m = 160.0, .spacing_m = 0.2, .point_count = 60000, .reach_m = 2.6, .laps = 2.0},
         0);
  adjust("window", {.length_m = 20.0, .spacing_m = 2.0, .point_count = 60}, 1);
}
