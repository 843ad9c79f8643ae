#include <gtest/gtest.h>

#include "tests/pipeline/session_residuals.hpp"
#include "tests/pipeline/visits.hpp"

// Landmarks that several sessions see must be as good as those of one session: a wrong match
// between visits must not survive in the map.

namespace roadbook {
namespace {

using test::quantile;
using test::Residuals;
using test::residuals_of;
using test::Visits;

TEST_F(Visits, AgreeOnTheirLandmarksAndWithTheTruth) {
  const std::filesystem::path file = folder() / "together.gpkg";
  const MapSummary& summary = together();
  const Residuals residuals = residuals_of(load_map(file));
  EXPECT_GT(residuals.joined, 300);
  EXPECT_LT(residuals.off, 0.01 * residuals.joined);
  const double joined_px = quantile(residuals.of_joined, 0.95);
  const double one_px = quantile(residuals.of_one, 0.95);
  EXPECT_LE(joined_px, 1.2 * one_px) << joined_px << " px, " << one_px << " px";

  ASSERT_TRUE(summary.ate_median_m) << summary.truth_apart;
  EXPECT_LT(*summary.ate_median_m, 0.03);
  EXPECT_LT(*summary.ate_p95_m, 0.06);
  ASSERT_EQ(summary.truth_sessions.size(), 3U);
  for (const SessionTruth& session : summary.truth_sessions)
    EXPECT_LT(session.offset.value().shift_m.norm(), 0.03) << session.session;
}

}  // namespace
}  // namespace roadbook
