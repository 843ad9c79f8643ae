#include "mapping/occupancy/scans.hpp"

#include <gtest/gtest.h>

#include "tests/mapping/occupancy/hall_scans.hpp"

namespace roadbook {
namespace {

// Expected distances come from the other readings, so that the noise of the map adds to that of the
// hits; shares within what 8,000 beams allow.
TEST(RangeScans, TheBeamModelOfADriveIsFittedWithoutAKnownMap) {
  const BeamMixture truth{0.06, 0.03, 0.04, 0.5};
  const auto drive = test::hall_drive(1, truth, 0.03, 240);
  const FittedBeams fitted = fit_beams(drive.scans, test::kHallMax_m, 0.02);
  ASSERT_TRUE(fitted.enough);
  EXPECT_NEAR(fitted.mixture.share[kShort], truth.shortened, 0.02);
  EXPECT_NEAR(fitted.mixture.share[kMaximum], truth.maximum, 0.01);
  EXPECT_NEAR(fitted.mixture.share[kCrosstalk], truth.crosstalk, 0.02);
  EXPECT_GT(fitted.mixture.sigma_m, 0.02);
  EXPECT_LT(fitted.mixture.sigma_m, 0.05);
}

TEST(RangeScans, FewReadingsKeepTheNominalModelAndSaySo) {
  const auto drive = test::hall_drive(1, {}, 0.03, 4);
  const FittedBeams fitted = fit_beams(drive.scans, test::kHallMax_m, 0.02);
  EXPECT_FALSE(fitted.enough);
  EXPECT_EQ(fitted.mixture.sigma_m, 0.02);
  EXPECT_EQ(fitted.mixture.hit(), 1.0);
}

// Walls 2 and 3 m away on either side: beams at random angles meet a surface after some 4 m.
TEST(RangeScans, DensityOfTheMapIsSurfacesPerMetreOfBeam) {
  const auto drive = test::hall_drive(1, {}, 0.001);
  double length = 0.0, echoes = 0.0;
  for (const RangeScan& scan : drive.scans)
    for (const ScanBeam& b : scan.beams) {
      length += b.read_m;
      echoes += b.read_m < test::kHallMax_m ? 1.0 : 0.0;
    }
  EXPECT_NEAR(surfaces_per_m(drive.scans, test::kHallMax_m), echoes / length, 1e-9);
}

}  // namespace
}  // namespace roadbook
