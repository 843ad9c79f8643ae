#include "sensors/range/inverse_range.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr double kLongest_m = 8.0;

RangeMixture inverse_mixture() {
  RangeMixture m;
  m.share = {0.10, 0.04, 0.06, 0.0};
  m.sigma_m = 0.08;
  m.wide = 0.0;
  m.short_rate_per_m = 0.6;
  m.anything = 0.0;
  return m;
}

double probability(const InverseRangeModel& inverse, float change) {
  return 1.0 / (1.0 + std::exp(-(inverse.prior_log_odds() + static_cast<double>(change))));
}

// The judge: worlds drawn from the prior, readings drawn from the forward model, and the share of
// worlds with an occupied cell among those with (nearly) one reading.
struct DrawnWorlds {
  std::vector<double> read;
  std::vector<std::vector<char>> occupied;  // by cell of 0.2 m
};

// `met`: share of the occupied cells whose surface the beam meets.
DrawnWorlds draw_worlds(double surfaces_per_m, double met, int count) {
  constexpr double kCell = 0.2;
  const int cells = static_cast<int>(kLongest_m / kCell);
  const double p = -std::expm1(-surfaces_per_m * kCell) / met;
  Random random(11);
  RangeModel sensor;
  sensor.max_m = kLongest_m;
  sensor.sigma_m = inverse_mixture().sigma_m;
  BeamMixture shares;
  shares.shortened = inverse_mixture().share[kShort];
  shares.maximum = inverse_mixture().share[kMaximum];
  shares.crosstalk = inverse_mixture().share[kCrosstalk];
  shares.short_rate_per_m = inverse_mixture().short_rate_per_m;
  DrawnWorlds worlds;
  for (int w = 0; w < count; ++w) {
    std::vector<char> occupied(static_cast<std::size_t>(cells), 0);
    double expected = kLongest_m;
    for (int c = cells - 1; c >= 0; --c) {
      if (random.uniform() >= p) continue;
      occupied[static_cast<std::size_t>(c)] = 1;
      if (random.uniform() < met) expected = kCell * (c + random.uniform());
    }
    worlds.read.push_back(predict_range(sensor, shares, expected, random.uniform(),
                                        random.uniform(), random.normal()));
    worlds.occupied.push_back(std::move(occupied));
  }
  return worlds;
}

TEST(InverseRange, IsThePosteriorOfWorldsThatTheForwardModelDraws) {
  constexpr double kDensity = 0.15;
  for (const double met : {1.0, 0.4}) {
    const InverseRangeModel inverse(inverse_mixture(), kLongest_m,
                                    {.cell_m = 0.2, .surfaces_per_m = kDensity, .met = met});
    const DrawnWorlds worlds = draw_worlds(kDensity, met, 400000);
    for (const double z : {1.5, 4.0, kLongest_m}) {
      SCOPED_TRACE(z);
      std::vector<double> count(40, 0.0);
      double all = 0.0;
      for (std::size_t w = 0; w < worlds.read.size(); ++w) {
        if (std::abs(worlds.read[w] - z) > (z < kLongest_m ? 0.05 : 1e-9)) continue;
        all += 1.0;
        for (std::size_t c = 0; c < count.size(); ++c) count[c] += worlds.occupied[w][c];
      }
      ASSERT_GT(all, 2000.0);
      const auto row = inverse.changes(z, 0.2);
      for (std::size_t c = 0; c < count.size() && 2 * c + 1 < row.size(); ++c) {
        const double p = probability(inverse, row[2 * c + 1]);
        const double share = count[c] / all;
        const double sigma = std::sqrt(std::max(share, 0.003) / all);
        EXPECT_NEAR(p, share, 4.0 * sigma + 0.03 * share) << c << " of " << all;
      }
    }
  }
}

TEST(InverseRange, AReadingSaysNothingBehindItsSurface) {
  RangeMixture sure = inverse_mixture();
  sure.sigma_m = 0.01;
  sure.share = {};
  const InverseRangeModel inverse(sure, kLongest_m, {.cell_m = 0.1, .surfaces_per_m = 0.1});
  const auto row = inverse.changes(4.0, 0.1);
  EXPECT_LT(std::abs(row.back()), 0.6F * row[80]);
  EXPECT_GT(row[80], 2.0F);
  // A ray that crosses an occupied cell misses its surface with probability 1 - q.
  EXPECT_NEAR(row[20], std::log(1.0 - kMetInCell), 1e-3);
}

// A sensor that often misses: an open beam says less than with one that never does.
TEST(InverseRange, NoEchoFreesLessIfTheSensorOftenMisses) {
  RangeMixture deaf = inverse_mixture();
  deaf.share = {0.0, 0.5, 0.0, 0.0};
  RangeMixture sure = inverse_mixture();
  sure.share = {};
  const InverseRangeOptions options{.cell_m = 0.1, .surfaces_per_m = 0.1, .met = 1.0};
  const InverseRangeModel of_deaf(deaf, kLongest_m, options), of_sure(sure, kLongest_m, options);
  EXPECT_LT(of_sure.changes(kLongest_m, 0.1)[30], of_deaf.changes(kLongest_m, 0.1)[30] - 3.0F);
  EXPECT_LT(of_deaf.changes(kLongest_m, 0.1)[30], -0.3F);
}

// One of the cells on the arc holds the echo: the wider the cone, the less each is suspected, and
// what lies before the arc is as free.
TEST(InverseRange, AWideBeamSharesTheEchoOutOverItsArc) {
  const InverseRangeOptions ray{.cell_m = 0.1, .surfaces_per_m = 0.1};
  InverseRangeOptions cone = ray;
  cone.cone_rad = 0.5;
  RangeMixture sure = inverse_mixture();
  sure.share = {};
  const InverseRangeModel narrow(sure, kLongest_m, ray), wide(sure, kLongest_m, cone);
  const float on_arc = wide.changes(5.0, 0.1)[100];
  EXPECT_LT(on_arc, narrow.changes(5.0, 0.1)[100] - 1.5F);
  EXPECT_GT(on_arc, 0.0F);
  EXPECT_LT(wide.changes(5.0, 0.1)[50], -3.0F);
}

TEST(InverseRange, OptionsOutsideTheirRangeAreRefused) {
  EXPECT_THROW(InverseRangeModel(inverse_mixture(), kLongest_m, {.met = 0.0}), InvalidOption);
  EXPECT_THROW(InverseRangeModel(inverse_mixture(), kLongest_m, {.cell_m = 0.0}), InvalidOption);
}

}  // namespace
}  // namespace roadbook
