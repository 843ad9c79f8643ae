#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "diagnosis/range/range_diagnosis.hpp"
#include "tests/diagnosis/range_corridor.hpp"

namespace roadbook {
namespace {

constexpr double kShare = 0.06;  // of readings that are off

// Returns true if the diagnosis finds outliers in beams whose ranges `disturb` has changed.
bool finds_outliers(const std::function<void(std::vector<RangeBeam>&, Random&)>& disturb) {
  std::vector<RangeBeam> beams = test::corridor();
  Random random(7, "disturbed beams");
  disturb(beams, random);
  const Diagnosis found = diagnose_ranges(expect_ranges(beams, 25.0));
  return std::any_of(found.causes.begin(), found.causes.end(),
                     [](const FoundCause& c) { return c.effect == "range0.outliers"; });
}

TEST(RangeOutliers, OfSingleBeamsTooShortAndTooLongAreNoise) {
  EXPECT_TRUE(finds_outliers([](std::vector<RangeBeam>& beams, Random& random) {
    for (RangeBeam& b : beams)
      if (random.uniform() < kShare) b.range_m += 0.15 * random.normal();
  }));
}

// People and clutter before a surface.
TEST(RangeOutliers, ThatAreTooShortOnlyAreNone) {
  EXPECT_FALSE(finds_outliers([](std::vector<RangeBeam>& beams, Random& random) {
    for (RangeBeam& b : beams)
      if (random.uniform() < kShare) b.range_m -= 0.15 * std::abs(random.normal());
  }));
}

// Eight neighbouring beams see an object that is present only at times.
TEST(RangeOutliers, ThatNeighbouringBeamsShareAreThingsThatMoved) {
  EXPECT_FALSE(finds_outliers([](std::vector<RangeBeam>& beams, Random& random) {
    for (std::size_t i = 0; i + 8 < beams.size(); ++i) {
      if (random.uniform() >= kShare / 8.0) continue;
      const double off = 0.15 * random.normal();
      for (std::size_t k = 0; k < 8; ++k) beams[i++].range_m += off + 0.01 * random.normal();
    }
  }));
}

}  // namespace
}  // namespace roadbook
