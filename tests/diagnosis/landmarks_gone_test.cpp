#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "diagnosis/map_changes/removed_landmarks.hpp"
#include "diagnosis/numerics/group_counts.hpp"

namespace roadbook {
namespace {

GroupCount alike(std::size_t items, int count, double chance) {
  return {std::vector<double>(items, chance), count};
}

TEST(GroupCounts, ProbabilitiesSumToOneAndHaveTheirMean) {
  for (const double scatter : {0.05, 0.3, 1.0})
    for (const double mean : {0.3, 0.5, 0.9}) {
      constexpr int kItems = 25;
      double sum = 0.0;
      double first = 0.0;
      for (int k = 0; k <= kItems; ++k) {
        const double p = std::exp(group_log(alike(kItems, k, mean), scatter));
        sum += p;
        first += k * p;
        EXPECT_NEAR(group_tail(alike(kItems, k, mean), scatter), sum, 1e-9);
      }
      EXPECT_NEAR(sum, 1.0, 1e-6);
      EXPECT_NEAR(first / kItems, mean, 0.02);  // the probit approximation
    }
}

// Against the sum over a hundred times as many nodes as one standard deviation in 4 has: the count
// of many items is a narrow peak.
TEST(GroupCounts, OfManyItemsAreTheIntegralsToo) {
  constexpr double kScatter = 2.0;
  for (const int items : {50, 100, 200, 400}) {
    const int count = items / 2;
    double sum = 0.0;
    constexpr double kSpacing = 2e-3;
    for (double z = -8.0; z <= 8.0; z += kSpacing) {
      const double share = 1.0 / (1.0 + std::exp(-kScatter * z));  // mean of 0.5
      const double ways =
          std::lgamma(items + 1.0) - std::lgamma(count + 1.0) - std::lgamma(items - count + 1.0);
      sum += std::exp(-0.5 * z * z + ways + count * std::log(share) +
                      (items - count) * std::log1p(-share));
    }
    const double log = std::log(sum * kSpacing / std::sqrt(2.0 * std::numbers::pi));
    EXPECT_NEAR(group_log(alike(static_cast<std::size_t>(items), count, 0.5), kScatter), log, 1e-3)
        << items;
  }
}

TEST(GroupCounts, WithoutScatterTheTailIsTheBinomials) {
  // By hand: 5 items at 0.4, one or none: 0.6^5 + 5 * 0.4 * 0.6^4.
  EXPECT_NEAR(group_tail(alike(5, 1, 0.4), 0.0), 0.33696, 1e-6);
}

// By hand: of 0.9, 0.5 and 0.2 none: 0.1 * 0.5 * 0.8; one: 0.9 * 0.5 * 0.8 + 0.1 * 0.5 * 0.8 +
// 0.1 * 0.5 * 0.2. Their mean says far more often none: (1 - 1.6 / 3)^3 = 0.10.
TEST(GroupCounts, EachItemHasItsOwnChance) {
  EXPECT_NEAR(group_tail({{0.9, 0.5, 0.2}, 0}, 0.0), 0.04, 1e-9);
  EXPECT_NEAR(group_tail({{0.9, 0.5, 0.2}, 1}, 0.0), 0.45, 1e-9);
}

// A deviation of all log odds together, by drawing.
TEST(GroupCounts, ItemsOfOneGroupDeviateTogether) {
  constexpr double kScatter = 0.7;
  constexpr int kDraws = 200'000;
  GroupCount group;
  for (int i = 0; i < 20; ++i) group.chances.push_back(0.2 + 0.03 * i);
  group.count = 4;
  // Log odds whose mean share is the chance lie further out than those of the chance itself.
  const double mean = group.expected() / 20.0;
  const double middle = std::log(mean / (1.0 - mean)) *
                        (std::sqrt(1.0 + std::numbers::pi / 8.0 * kScatter * kScatter) - 1.0);
  Random random(5, "draws");
  int fewer = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const double off = random.normal(middle, kScatter);
    int count = 0;
    for (const double c : group.chances)
      count += random.uniform() < 1.0 / (1.0 + (1.0 - c) / c * std::exp(-off)) ? 1 : 0;
    fewer += count <= group.count ? 1 : 0;
  }
  const double share = static_cast<double>(fewer) / kDraws;
  EXPECT_NEAR(group_tail(group, kScatter), share, 4.0 * std::sqrt(share / kDraws) + 0.02 * share);
}

TEST(GroupCounts, TheScatterIsAnUpperBoundThatFallenGroupsDoNotRaise) {
  constexpr double kScatter = 0.4;
  constexpr int kDraws = 60;
  int below = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Random random(7, "groups", static_cast<std::uint64_t>(draw));
    std::vector<GroupCount> groups;
    for (int g = 0; g < 100; ++g) {
      GroupCount group = alike(10 + random.below(30), 0, 0.5);
      const double share = 1.0 / (1.0 + std::exp(-random.normal(0.0, kScatter)));
      for (std::size_t i = 0; i < group.chances.size() && g > 4; ++i)
        group.count += random.uniform() < share ? 1 : 0;
      groups.push_back(group);
    }
    const double scatter = scatter_of(groups);
    below += scatter < kScatter ? 1 : 0;
    EXPECT_LT(scatter, 0.8);
  }
  // 5 % by its definition, a step of the search is 25 %.
  EXPECT_LT(below, 0.2 * kDraws);
  EXPECT_GT(scatter_of(std::array<GroupCount, 0>{}), 0.4);  // no group: the default
}

struct OwnPlace {
  double wave_m = 0.0;  // length over which the rate of being found changes; 0: not at all
  double odds = 0.0;    // by which, in log odds
  double gone_m = 0.0;  // radius about (20, 5) without any object
};

// Landmarks over 60 m by 12 m; half of them are detected again. The rate varies from place to place
// and grows with the expected number of detections.
std::vector<LandmarkRedetection> scattered(std::uint64_t seed, const OwnPlace& place) {
  Random random(seed, "scattered");
  const double phase = random.uniform(0.0, 6.3);
  std::vector<LandmarkRedetection> all;
  for (int i = 0; i < 3000; ++i) {
    LandmarkRedetection c;
    c.landmark = i;
    c.p_map = {random.uniform(0.0, 60.0), random.uniform(0.0, 12.0), random.uniform(0.0, 3.0)};
    c.expected = random.uniform(1.0, 12.0);
    c.views = 4 + static_cast<int>(random.below(20));
    c.range_m = random.uniform(1.0, 8.0);
    double odds = -0.8 + 0.6 * std::log(c.expected);
    if (place.wave_m > 0.0)
      odds += place.odds * std::sin(c.p_map.x() / place.wave_m + phase) *
              std::sin(c.p_map.y() / place.wave_m + phase);
    c.found = random.uniform() < 1.0 / (1.0 + std::exp(-odds));
    if ((c.p_map.head<2>() - Eigen::Vector2d(20.0, 5.0)).norm() < place.gone_m) c.found = false;
    c.sightings = c.found ? static_cast<int>(c.expected) : 0;
    all.push_back(c);
  }
  return all;
}

TEST(RemovedLandmarks, NoPlaceIsNamedWhereTheRateOnlyChangesFromPlaceToPlace) {
  for (const double wave_m : {0.0, 0.5, 2.0, 8.0})
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const RemovedLandmarks g = removed_landmarks(scattered(seed, {wave_m, 0.8, 0.0}));
      EXPECT_TRUE(g.places.empty())
          << "seed " << seed << ", wave " << wave_m << ": " << g.places.front().middle.transpose();
      EXPECT_GT(g.tests, 500U);
    }
}

// The share counts landmarks of named cells only. Parts of the disc in other cells do not count, so
// the share is a lower bound.
TEST(RemovedLandmarks, APlaceThatIsEmptyIsNamedWithItsShare) {
  const Eigen::Vector2d middle(20.0, 5.0);
  int covered = 0;
  constexpr int kSeeds = 12;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto chances = scattered(seed, {2.0, 0.4, 2.4});
    const auto is_gone = [&](const LandmarkRedetection& c) {
      return (c.p_map.head<2>() - middle).norm() < 2.4;
    };
    const RemovedLandmarks g = removed_landmarks(chances);
    ASSERT_EQ(g.places.size(), 1U) << "seed " << seed;
    const FoundPlace& p = g.places.front();
    EXPECT_LT((p.middle.head<2>() - middle).norm(), 1.0);
    EXPECT_LT(p.reach_m, 4.5);
    EXPECT_LT(p.p, 0.005);
    EXPECT_GT(p.expected, 3.0 * static_cast<double>(p.found));
    EXPECT_EQ(p.landmarks, g.judged.size());
    const auto all = static_cast<double>(std::count_if(chances.begin(), chances.end(), is_gone));
    const auto there = static_cast<double>(std::count_if(
        g.judged.begin(), g.judged.end(), [&](std::size_t i) { return is_gone(chances[i]); }));
    covered += std::abs(g.gone - there) < 1.96 * g.sigma ? 1 : 0;
    EXPECT_GT(there, 0.4 * all) << "seed " << seed;
    EXPECT_LT(g.gone - 1.96 * g.sigma, all) << "seed " << seed;
  }
  // Of twelve intervals of 95 % fewer than 10 hold with a probability of 2 %.
  EXPECT_GE(covered, 10);
}

// A fifth of the map is removed: similar regions must not mask each other, and one of many may be
// less significant than a single one.
TEST(RemovedLandmarks, ManyPlacesThatAreEmptyDoNotHideEachOther) {
  constexpr double kRadius = 1.6;
  // Discs are 7.5 m by 6 m apart. Returns the index of the disc that contains the landmark, or -1.
  const auto disc_of = [](const LandmarkRedetection& c) {
    const double column = std::round(c.p_map.x() / 7.5);
    const int row = c.p_map.y() < 6.0 ? 0 : 1;
    const Eigen::Vector2d middle(7.5 * column, 3.0 + 6.0 * row);
    return (c.p_map.head<2>() - middle).norm() < kRadius ? 2 * static_cast<int>(column) + row : -1;
  };
  int named = 0;
  int discs = 0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    std::vector<LandmarkRedetection> chances = scattered(seed, {2.0, 0.4, 0.0});
    std::array<int, 18> there{};
    std::array<int, 18> judged{};
    for (LandmarkRedetection& c : chances)
      if (const int disc = disc_of(c); disc >= 0) {
        c.found = false;
        ++there.at(static_cast<std::size_t>(disc));
      }
    const RemovedLandmarks g = removed_landmarks(chances);
    int stand = 0;
    for (const std::size_t i : g.judged)
      if (const int disc = disc_of(chances[i]); disc >= 0)
        ++judged.at(static_cast<std::size_t>(disc));
      else
        ++stand;
    EXPECT_LT(3 * stand, static_cast<int>(g.judged.size())) << "seed " << seed;
    for (std::size_t d = 0; d < there.size(); ++d) {
      if (there.at(d) < 25) continue;
      ++discs;
      named += 3 * judged.at(d) >= there.at(d) ? 1 : 0;
    }
  }
  EXPECT_GE(10 * named, 9 * discs) << named << " of " << discs;
  EXPECT_GT(discs, 40);
}

}  // namespace
}  // namespace roadbook
