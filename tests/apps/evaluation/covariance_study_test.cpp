#include "apps/evaluation/covariance/covariance_study.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "base/random.hpp"
#include "base/temporary_folder.hpp"
#include "sim/simulate.hpp"

namespace roadbook {
namespace {

Vector6d drawn(const Matrix6d& covariance, Random& random) {
  Vector6d normal;
  for (int i = 0; i < 6; ++i) normal[i] = random.normal();
  return covariance.llt().matrixL() * normal;
}

// A map of keyframes at the true poses of a drive, each with an error drawn from `covariance`. The
// map states `stated` times that covariance. The first keyframe holds the gauge.
Map map_with_errors(const Drive& drive, const Matrix6d& covariance, double stated) {
  Random random(3, "errors");
  Map map;
  const auto truth = drive.truth();
  const Eigen::Isometry3d T_first_world = truth.front().T_world_vehicle.inverse();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int k = static_cast<int>(i);
    Keyframe keyframe;
    keyframe.t_ns = truth[i].t_ns;
    keyframe.map_frame = k;
    keyframe.covariance = stated * covariance;
    Eigen::Isometry3d T = T_first_world * truth[i].T_world_vehicle;
    if (i > 0) T = T * se3_exp(drawn(covariance, random)).inverse();
    map.map_frames.push_back({T});
    map.keyframes.push_back(keyframe);
  }
  map.keyframes.front().covariance.setZero();
  return map;
}

// Poses whose errors have exactly the stated covariance: 95 % lie inside, up to three standard
// errors of that share, and the mean squared error is one variance.
TEST(CovarianceStudy, AMapThatStatesItsErrorsHas95PercentInside) {
  const TemporaryFolder folder;
  SimulateOptions options;
  options.images = false;
  options.max_duration_s = 20.0;
  simulate(load_scenario("zurich", {.size = "small"}), folder.path() / "drive", options);
  const Drive drive = Drive::open(folder.path() / "drive");
  Matrix6d covariance = Matrix6d::Identity() * 1e-4;
  covariance(0, 1) = covariance(1, 0) = 0.8e-4;
  covariance(5, 0) = covariance(0, 5) = -0.5e-4;
  covariance(5, 5) = 4e-4;
  const Coverage right = coverage_of(map_with_errors(drive, covariance, 1.0), drive);
  const double n = static_cast<double>(right.six.count);
  ASSERT_GT(n, 200.0);
  EXPECT_EQ(right.unknown, 0U);
  EXPECT_EQ(right.landmarks.count, 0U);
  EXPECT_TRUE(std::isnan(right.landmarks.share()));
  const double standard_error = std::sqrt(0.95 * 0.05 / n);
  for (const RegionShare* region :
       {&right.position, &right.position_3d, &right.heading, &right.six}) {
    EXPECT_NEAR(region->share(), 0.95, 3.0 * standard_error);
    EXPECT_NEAR(region->mean_square(), 1.0, 3.0 * std::sqrt(2.0 / n));
  }
  // A quarter of the covariance: a normal error lies within half its 95 % interval in 67.3 %.
  const Coverage narrow = coverage_of(map_with_errors(drive, covariance, 0.25), drive);
  EXPECT_NEAR(narrow.heading.share(), 0.673, 3.0 * std::sqrt(0.673 * 0.327 / n));
  EXPECT_NEAR(narrow.six.mean_square(), 4.0, 12.0 * std::sqrt(2.0 / n));
}

// The short version of `roadbook evaluate covariance`: a drive of 19 m in small images. The errors
// of one drive hang together, so that their mean square is one draw: at most the 95 % bound of chi
// square with one degree of freedom. Regions of any size would hold everything.
TEST(CovarianceStudy, ASimulatedDriveIsCovered) {
  const CoverageKind kind{"no loops 160x120", 0.25, 10.0, {}, ""};
  const CoverageTally tally = coverage_of_drive(kind, 2, 0);
  EXPECT_EQ(tally.drives, 1U);
  EXPECT_EQ(tally.refused, 0U);
  const Coverage& c = tally.coverage;
  EXPECT_EQ(c.unknown, 0U);
  ASSERT_GT(c.position.count, 50U);
  EXPECT_GT(c.landmarks.count, 0U);  // few: small images show outlines nearly everywhere
  for (const RegionShare* region : {&c.position, &c.position_3d, &c.heading}) {
    EXPECT_LT(region->mean_square(), 3.84);
    EXPECT_GT(region->mean_square(), 0.05);
  }
}

}  // namespace
}  // namespace roadbook
