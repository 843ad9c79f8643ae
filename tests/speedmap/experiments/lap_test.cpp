#include <gtest/gtest.h>

#include "base/error.hpp"
#include "speedmap/experiments/lap_study.hpp"
#include "speedmap/experiments/spm_experiment.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

// Measured: 0.126 degrees against 0.250 (KF) and 0.242 (GP) on the last 100 m; a memory of the
// first lap without classes is better still (0.032), which docs/results/friction.md says.
TEST(Laps, TheFirstLapOfARealCarPredictsTheSecondAheadOfIt) {
  ROADBOOK_REQUIRE_DATA(folder, "indy_av21");
  const LapData laps = read_laps(folder / "Putnam_park2023_run4_2.csv");
  EXPECT_NEAR(laps.length_m, 2838.0, 5.0);  // two laps of 2837 and 2839 m, says its README
  const auto scores = run_lap_study(laps, 2);
  const double map = quantile(scores[0].mean_abs, 0.5);
  EXPECT_LT(map, 0.6 * quantile(scores[1].mean_abs, 0.5));
  EXPECT_LT(map, 0.6 * quantile(scores[2].mean_abs, 0.5));
}

TEST(Laps, ATableWithoutLapsIsRefused) {
  ROADBOOK_REQUIRE_DATA(folder, "indy_av21");
  EXPECT_THROW((void)read_laps(folder / "putnam_inner_bound.csv"), BadInput);
  EXPECT_THROW((void)read_laps(folder / "none.csv"), BadInput);
}

}  // namespace
}  // namespace roadbook
