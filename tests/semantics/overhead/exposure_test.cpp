#include "semantics/overhead/exposure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.hpp"

namespace roadbook {
namespace {

using Samples = std::vector<std::vector<ExposureSample>>;

constexpr int kWindow = 12;   // places that one image sees
constexpr int kPerPlace = 8;  // places side by side, so that one noisy sample has little influence

// A drive along a street: image i sees the places from i on, the far ones last. `brighter` is the
// change of a place's log brightness in an image, by distance. Without classes of distances, only
// the prior limits errors that add up.
template <typename Brighter>
Samples chain(int images, const Brighter& brighter, bool with_distances = true) {
  Samples samples(static_cast<std::size_t>(images));
  for (int i = 0; i < images; ++i)
    for (int k = 0; k < kWindow; ++k)
      for (int side = 0; side < kPerPlace; ++side)
        samples[static_cast<std::size_t>(i)].push_back(
            {(i + k) * kPerPlace + side, static_cast<float>(std::log(90.0) + brighter(i, k, side)),
             with_distances ? k : 0});
  return samples;
}

double largest_log(const std::vector<double>& gains) {
  double largest = 0.0;
  for (const double gain : gains) largest = std::max(largest, std::abs(std::log(gain)));
  return largest;
}

// Far ground is 1 % brighter for each step of distance, as with glare along the street. The
// overlaps then require each image to be 1 % brighter than the one before, a factor of 20 after 300
// images. In a long chain with prior p, the cost of a sample is window^2 / 12 (g' + 0.01)^2 + p
// g^2. The solution is g = 0 except near the two ends. There, |g| = 0.01 window / sqrt(12 p), which
// decays within window / sqrt(12 p) images.
TEST(Exposure, ErrorsThatAddUpAlongADriveAreHeld) {
  const GainOptions options;
  const auto brighter = [](int, int k, int) { return 0.01 * k; };
  const auto gains = estimate_gains(chain(300, brighter, false), options);
  const double reach = kWindow / std::sqrt(12.0 * options.prior_share);
  EXPECT_LT(largest_log(gains), 1.2 * 0.01 * reach);
  const auto ends = static_cast<std::size_t>(6.0 * reach);
  for (std::size_t i = ends; i + ends < gains.size(); ++i) EXPECT_NEAR(gains[i], 1.0, 0.01) << i;
  // With known distances, all images have the same shade, and the gains stay near 1.
  EXPECT_LT(largest_log(estimate_gains(chain(300, brighter), options)), 0.01);
}

// Paint that blooms in far views, under varying glare; then an effect that is much stronger.
TEST(Exposure, PaintThatBloomsDoesNotRunAway) {
  Random random(7);
  const auto blooming = [&](int i, int k, int side) {
    const double paint = side < 2 ? 0.7 + 0.05 * k : 0.0;
    return paint + (0.02 + 0.02 * std::sin(0.05 * i)) * k + random.normal(0.0, 0.05);
  };
  EXPECT_LT(largest_log(estimate_gains(chain(400, blooming))), 0.20);
  EXPECT_LT(largest_log(estimate_gains(chain(400, blooming, false))), 0.50);
  const auto absurd = [](int, int k, int) { return 0.5 * k; };
  const GainOptions options;
  const auto gains = estimate_gains(chain(400, absurd, false), options);
  EXPECT_LE(*std::max_element(gains.begin(), gains.end()), options.most_gain);
  EXPECT_GE(*std::min_element(gains.begin(), gains.end()), 1.0 / options.most_gain);
}

// Images with different gains on the same ground. The prior reduces each corrected step by its
// share and by no more.
TEST(Exposure, TrueStepsAreCorrected) {
  Random random(3);
  std::vector<double> gains_there;
  for (int i = 0; i < 60; ++i) gains_there.push_back(random.uniform(0.75, 1.2));
  const auto gains = estimate_gains(chain(60, [&](int i, int k, int side) {
    const double place = 0.3 * std::sin(0.7 * (i + k)) + 0.1 * side;
    return place + std::log(gains_there[static_cast<std::size_t>(i)]);
  }));
  double low = 10.0;
  double high = 0.0;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    low = std::min(low, gains[i] * gains_there[i]);
    high = std::max(high, gains[i] * gains_there[i]);
  }
  EXPECT_LT(std::log(high / low), 0.08 * std::log(1.2 / 0.75) + 0.03);
}

// Two visits to one street, one at half the brightness.
TEST(Exposure, TwoVisitsOfOnePlaceBecomeEquallyBright) {
  Samples samples = chain(50, [](int, int, int) { return 0.0; });
  const Samples darker = chain(50, [](int, int, int) { return -0.5 * std::log(2.0); });
  samples.insert(samples.end(), darker.begin(), darker.end());
  const auto gains = estimate_gains(samples);
  const double step = 0.5 * std::log(2.0);
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_NEAR(std::log(gains[50 + i] / gains[i]), step, 0.06 * step) << i;
}

TEST(Exposure, AnImageThatSharesNothingKeepsItsBrightness) {
  Samples samples = chain(2, [](int i, int, int) { return 0.2 * i; });
  samples.push_back({{-1, 5.0F}, {-2, 5.1F}});
  samples.emplace_back();
  const auto gains = estimate_gains(samples);
  EXPECT_DOUBLE_EQ(gains[2], 1.0);
  EXPECT_DOUBLE_EQ(gains[3], 1.0);
  EXPECT_TRUE(estimate_gains({}).empty());
}

}  // namespace
}  // namespace roadbook
