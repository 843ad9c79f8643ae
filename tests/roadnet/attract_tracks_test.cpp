#include "roadnet/attract_tracks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "tests/roadnet/chicago.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

constexpr double kScatter_m = 10.0;

/// Passes along y = `y_m`, in both directions. Each pass has a separate lateral error of 10 m
/// (standard deviation).
std::vector<DrivenPass> street(double y_m, int count, std::uint64_t seed) {
  Random random(seed, "street");
  std::vector<DrivenPass> passes;
  for (int p = 0; p < count; ++p) {
    const double offset = kScatter_m * random.normal();
    DrivenPass pass;
    for (double x = 0.0; x <= 600.0; x += 10.0) pass.positions.emplace_back(x, y_m + offset, 0.0);
    if (p % 2 == 1) std::reverse(pass.positions.begin(), pass.positions.end());
    passes.push_back(pass);
  }
  return passes;
}

std::vector<double> sides(const std::vector<DrivenPass>& passes, double y_m) {
  std::vector<double> all;
  for (const DrivenPass& pass : passes)
    for (const auto& p : pass.positions)
      if (p.x() > 50.0 && p.x() < 550.0) all.push_back(p.y() - y_m);
  return all;
}

// In a band of spread r, a mean shift with a window of s = 12 m leaves r^2 / (r^2 + s^2) of an
// offset. An offset of 10 m thus becomes 4.1 m, 0.4 m and almost zero in three rounds. The
// remaining offset comes from cells of 4 m and from the cut of the window, which does not move
// outliers beyond it. The bound therefore applies to nine tenths of the passes.
TEST(DrawTogether, AWideBandOfPassesBecomesALineAtItsMiddle) {
  const auto passes = street(0.0, 200, 1);
  const auto before = sides(passes, 0.0);
  double mean = 0.0;
  for (const double s : before) mean += s / static_cast<double>(before.size());
  auto after = sides(attract_passes(passes, {}), 0.0);
  std::sort(after.begin(), after.end());
  const double low = after[after.size() / 20];
  const double high = after[after.size() - after.size() / 20];
  EXPECT_LT(high - low, 4.0);  // one cell
  // The middle of 200 passes is known to 10 / sqrt(200) m, the mode of a window to about twice
  // that.
  EXPECT_NEAR(0.5 * (low + high), mean, 2.0 * kScatter_m / std::sqrt(200.0) + 1.0);
}

// At an end, all neighbours lie on one side. A mean shift along the street would shorten the street
// by 10 m in each round.
TEST(DrawTogether, StreetsKeepTheirLength) {
  for (const DrivenPass& pass : attract_passes(street(0.0, 200, 6), {})) {
    const double a = pass.positions.front().x();
    const double b = pass.positions.back().x();
    EXPECT_NEAR(std::min(a, b), 0.0, 2.0);
    EXPECT_NEAR(std::max(a, b), 600.0, 2.0);
  }
}

TEST(DrawTogether, TwoStreetsAHundredMetresApartStayWhereTheyAre) {
  auto passes = street(0.0, 100, 2);
  const auto other = street(100.0, 100, 3);
  passes.insert(passes.end(), other.begin(), other.end());
  const auto moved = attract_passes(passes, {});
  for (std::size_t p = 0; p < moved.size(); ++p) {
    const double y_m = p < 100 ? 0.0 : 100.0;
    for (const double s : sides({moved[p]}, y_m)) EXPECT_LT(std::abs(s), 3.0 * kScatter_m);
  }
}

TEST(DrawTogether, ACrossStreetDoesNotPullAlongItself) {
  auto passes = street(0.0, 100, 4);
  std::vector<DrivenPass> cross;
  for (DrivenPass pass : street(300.0, 100, 5)) {
    for (auto& p : pass.positions) p = Eigen::Vector3d(p.y(), p.x() - 300.0, 0.0);
    cross.push_back(pass);
  }
  const std::vector<DrivenPass> alone = attract_passes(passes, {});
  passes.insert(passes.end(), cross.begin(), cross.end());
  const std::vector<DrivenPass> together = attract_passes(passes, {});
  for (std::size_t p = 0; p < alone.size(); ++p)
    for (std::size_t i = 0; i < alone[p].positions.size(); ++i)
      EXPECT_LT((alone[p].positions[i] - together[p].positions[i]).norm(), 1e-9);
}

// The figures wanted of the Chicago tracks; the best published methods trade one for the other.
TEST(DrawTogether, TheStreetsOfChicagoAreFoundAndFewThatAreNone) {
  ROADBOOK_REQUIRE_DATA(folder, "road_tracks");
  const auto passes = test::chicago_passes(folder);
  ASSERT_GT(passes.size(), 800U);
  const RoadNetwork network = build_road_network(passes, RoadNetworkOptions::for_gps());
  const auto score =
      test::compare_by_length(network, test::chicago_reference(folder), passes, 15.0, 3);
  EXPECT_GE(score.precision, 0.9);
  EXPECT_GE(score.recall, 0.85);
}

}  // namespace
}  // namespace roadbook
