#include "mapping/optimisation/common_errors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cstdio>

#include "mapping/cameras/principal_point.hpp"
#include "mapping/optimisation/cluster_covariance.hpp"
#include "tests/mapping/synthetic_bundle.hpp"

namespace roadbook {
namespace {

// All pixels 1 % farther from the optical axis, as longer focal lengths of all cameras make them.
CommonError longer_focal_lengths(const BundleProblem& problem) {
  CommonError error;
  error.size = CommonErrorSize::kIfShown;
  for (const BundleObservation& seen : problem.observations)
    error.pixels.push_back(
        0.01 * (seen.pixel -
                principal_point(problem.cameras[static_cast<std::size_t>(seen.camera)].camera)));
  return error;
}

// Of 2 drives whose calibrations state focal lengths that are `wrong` too long and too short: the
// mean squared error of poses over the covariance, without and with the error in the covariance.
struct Normalised {
  double without = 0.0;
  double with = 0.0;
};
Normalised normalised_errors(double wrong) {
  Normalised sums;
  int count = 0;
  for (std::uint64_t seed = 50; seed < 52; ++seed) {
    test::SyntheticBundle s = test::synthetic_bundle(
        {.length_m = 40.0, .spacing_m = 0.5, .point_count = 200, .sigma_px = 0.3}, seed);
    for (MountedCamera& mounted : s.problem.cameras)
      for (std::size_t i = 0; i < 2; ++i)
        mounted.camera.parameters[i] *= seed % 2 == 0 ? 1.0 + wrong : 1.0 - wrong;
    const BundleOptions options = test::exact_options();
    EXPECT_TRUE(bundle_adjust(s.problem, options).usable);
    const std::vector<int> piece(s.problem.poses.size(), 0);
    const auto without = cluster_covariance(s.problem, {}, piece, options);
    const auto with =
        cluster_covariance(s.problem, {}, piece, options, {}, {longer_focal_lengths(s.problem)});
    for (std::size_t i = 10; i < s.poses.size(); i += 10) {
      const Vector6d e = se3_log(s.problem.poses[i].T_map_vehicle.inverse() * s.poses[i]);
      sums.without += e.dot(without.poses[i].ldlt().solve(e)) / 6.0;
      sums.with += e.dot(with.poses[i].ldlt().solve(e)) / 6.0;
      ++count;
    }
  }
  std::printf("squared errors over variances: without %.2f, with %.2f\n", sums.without / count,
              sums.with / count);
  return {sums.without / count, sums.with / count};
}

// Focal lengths that are all wrong by one factor contradict no camera: only the residuals of all
// together show them.
TEST(CommonErrors, FocalLengthsOfAllCamerasWidenTheCovariancesWhereTheResidualsShowThem) {
  const Normalised errors = normalised_errors(0.03);
  EXPECT_GT(errors.without, 4.0);
  EXPECT_LT(errors.with, 1.2);
  EXPECT_GT(errors.with, 0.1);
}

// What nothing speaks for does not count: the same bits.
TEST(CommonErrors, RightFocalLengthsLeaveTheCovariancesAsTheyAre) {
  const Normalised errors = normalised_errors(0.0);
  EXPECT_EQ(errors.with, errors.without);
  EXPECT_LT(errors.with, 1.5);
}

}  // namespace
}  // namespace roadbook
