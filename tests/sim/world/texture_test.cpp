#include "sim/world/texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/random.hpp"
#include "sim/world/noise.hpp"
#include "sim/world/texture_lookup.hpp"

namespace roadbook {
namespace {

cv::Mat random_image(int rows, int cols) {
  Random random(5, "texture");
  cv::Mat image(rows, cols, CV_8UC1);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < cols; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(256));
  return image;
}

/// Places inside and far outside, footprints from less than a texel to more than the image.
Lookups random_places(std::uint64_t seed, double reach) {
  Random random(seed, "places");
  Lookups lookups;
  for (std::size_t i = 0; i < 380; ++i)
    lookups.add(static_cast<float>(random.uniform(-reach, reach)),
                static_cast<float>(random.uniform(-reach, reach)),
                static_cast<float>(std::exp2(random.uniform(-2.0, 9.0))), i);
  return lookups;
}

TEST(Texture, EightPlacesAtOnceAreTheSameBitsAsOneByOne) {
  for (const bool tiled : {false, true}) {
    const Texture texture(tiled ? random_image(64, 128) : random_image(61, 117), tiled);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Lookups lookups = random_places(seed, 300.0);
      texture.look_up(lookups);
      for (std::size_t i = 0; i < lookups.count; ++i)
        EXPECT_EQ(lookups.value[i],
                  texture.sample(lookups.x[i], lookups.y[i], lookups.footprint[i]));
    }
  }
}

// The finest level against the definition of bilinear interpolation in double precision. Shares
// are cut to 1/256: at most 255 / 256 of a grey level per axis; single precision of the coordinates
// adds 255 * 2^-17.
TEST(Texture, IsBilinearBetweenTexelsAndGoesOnAtItsBorderOrRepeats) {
  for (const bool tiled : {false, true}) {
    const cv::Mat image = random_image(64, 128);
    const Texture texture(image, tiled);
    const auto texel = [&](int x, int y) {
      const auto place = [&](int i, int n) {
        return tiled ? ((i % n) + n) % n : std::clamp(i, 0, n - 1);
      };
      return static_cast<double>(image.at<std::uint8_t>(place(y, 64), place(x, 128)));
    };
    Lookups lookups = random_places(3, 200.0);
    std::fill_n(lookups.footprint.begin(), lookups.count, 0.5F);
    texture.look_up(lookups);
    for (std::size_t i = 0; i < lookups.count; ++i) {
      const auto x = static_cast<double>(lookups.x[i]);
      const auto y = static_cast<double>(lookups.y[i]);
      const int x0 = static_cast<int>(std::floor(x));
      const int y0 = static_cast<int>(std::floor(y));
      const double a = x - x0;
      const double b = y - y0;
      const double expected = (1.0 - b) * ((1.0 - a) * texel(x0, y0) + a * texel(x0 + 1, y0)) +
                              b * ((1.0 - a) * texel(x0, y0 + 1) + a * texel(x0 + 1, y0 + 1));
      EXPECT_NEAR(static_cast<double>(lookups.value[i]), expected, 2.0 * 255.0 / 256.0 + 0.01);
    }
  }
}

TEST(Texture, WideFootprintsSeeTheMean) {
  const cv::Mat image = random_image(64, 64);
  const Texture texture(image, true);
  // The last level is the mean, rounded up to half a level in each of six halvings.
  EXPECT_NEAR(static_cast<double>(texture.sample(10.0F, 20.0F, 200.0F)), cv::mean(image)[0], 3.0);
}

TEST(Noise, RowsAreTheSameBitsAsPlaces) {
  std::vector<float> x, row;
  for (int i = 0; i < 1003; ++i) x.push_back(-20.0F + 0.0317F * static_cast<float>(i));
  row.resize(x.size());
  for (const float y : {-3.2F, 0.0F, 17.77F}) {
    fractal_noise_row(x, y, 4, 9U, row);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(row[i], fractal_noise(x[i], y, 4, 9U));
    value_noise_row(x, y, 9U, row);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(row[i], value_noise(x[i], y, 9U));
  }
  const std::vector<float> back(x.rbegin(), x.rend());
  fractal_noise_at(x, back, 5, 7U, row);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(row[i], fractal_noise(x[i], back[i], 5, 7U));
}

TEST(Noise, IsSmoothAndKeepsItsRange) {
  float largest = 0.0F;
  for (int i = 0; i < 20000; ++i) {
    const float x = -50.0F + 0.005F * static_cast<float>(i);
    const float value = value_noise(x, 0.3F, 1U);
    EXPECT_LE(std::abs(value), 1.0F);
    // The steepest slope of the blend is 1.5, between values at most 2 apart.
    EXPECT_LE(std::abs(value_noise(x + 0.005F, 0.3F, 1U) - value), 0.005F * 3.0F + 1e-5F);
    largest = std::max(largest, std::abs(value));
  }
  EXPECT_GT(largest, 0.5F);
}

}  // namespace
}  // namespace roadbook
