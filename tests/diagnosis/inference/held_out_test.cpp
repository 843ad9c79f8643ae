#include "diagnosis/inference/held_out.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "diagnosis/inference/checks.hpp"
#include "diagnosis/inference/score_table.hpp"

namespace roadbook {
namespace {

// White rows of 0.02 s with one column of unit variance and an effect of the given size.
Innovations white(std::uint64_t seed, double size, std::size_t rows) {
  Random random(seed);
  Innovations in;
  in.sides = 2;
  for (std::size_t i = 0; i < rows; ++i) {
    const double s = random.normal();
    in.of.push_back({i, 0, 0.02 * static_cast<double>(i), 1.0});
    in.values.insert(in.values.end(), {size * s + random.normal(), s});
  }
  return in;
}

// Known in closed form: with N rows and size b the gain of the true size is N b^2 / 2 in the mean,
// and fitting it on nine tenths costs about 1/2 (1 + 1/9) nats more.
TEST(HeldOut, GainOfATrueCauseIsThatOfTheClosedForm) {
  constexpr std::size_t kRows = 5000;
  constexpr double kSize = 0.2;
  double sum = 0.0;
  constexpr int kRuns = 40;
  for (int i = 0; i < kRuns; ++i)
    sum +=
        held_out_gain(white(static_cast<std::uint64_t>(i) + 1, kSize, kRows), {}, {1}, {1.0}, false)
            .total;
  const double expected = 0.5 * kRows * kSize * kSize;
  // The gain scatters by sqrt(N) b about its mean.
  const double sigma = std::sqrt(static_cast<double>(kRows)) * kSize / std::sqrt(kRuns);
  EXPECT_NEAR(sum / kRuns, expected, 4.0 * sigma);
}

TEST(HeldOut, ACauseThatIsNotThereGainsNothing) {
  double sum = 0.0;
  constexpr int kRuns = 100;
  for (int i = 0; i < kRuns; ++i)
    sum +=
        held_out_gain(white(static_cast<std::uint64_t>(i) + 500, 0.0, 2000), {}, {1}, {1.0}, false)
            .total;
  EXPECT_LT(sum / kRuns, 0.0);  // fitting noise costs
  EXPECT_GT(sum / kRuns, -2.0);
}

// On a straight line two fits and one with a further column are the same.
TEST(HeldOut, OfReadingsThatDoNotBendTwoFitsGainWhatOneWithAFurtherColumnDoes) {
  const Innovations in = white(7, 0.2, 3000);
  const HeldOutGain one = held_out_gain(in, {}, {1}, {1.0}, false);
  const HeldOutGain two = held_out_gain({in, {}}, {in, {1}}, false);
  EXPECT_GT(one.total, 20.0);
  EXPECT_NEAR(two.total, one.total, 1e-9);
  EXPECT_NEAR(two.low, one.low, 1e-9);
}

TEST(Checks, ChiSquaredTailMeetsTabulatedValues) {
  // Abramowitz and Stegun, table 26.8: 5 % points.
  EXPECT_NEAR(chi_squared_tail(3.841459, 1), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(5.991465, 2), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(7.814728, 3), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(11.070498, 5), 0.05, 1e-6);
  EXPECT_NEAR(chi_squared_tail(31.410433, 20), 0.05, 1e-6);
}

TEST(Checks, LjungBoxSeesCorrelatedAndAcceptsWhiteNoise) {
  Random random(3);
  std::vector<double> noise, correlated{0.0};
  for (int i = 0; i < 2000; ++i) {
    noise.push_back(random.normal());
    correlated.push_back(0.3 * correlated.back() + noise.back());
  }
  EXPECT_GT(chi_squared_tail(ljung_box(noise, 20), 20), 1e-3);
  EXPECT_LT(chi_squared_tail(ljung_box(correlated, 20), 20), 1e-12);
}

}  // namespace
}  // namespace roadbook
