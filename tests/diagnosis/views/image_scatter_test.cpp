#include "diagnosis/views/image_scatter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr Eigen::Index kScatterDraws = 4;
constexpr int kScatterViews = 3;  // of a camera in an image

ViewData two_cameras(int images) {
  ViewData data;
  data.bundle.cameras.resize(2);
  data.bundle.poses.resize(static_cast<std::size_t>(images));
  for (int k = 0; k < images; ++k)
    for (int v = 0; v < 2 * kScatterViews; ++v) {
      BundleObservation& seen = data.bundle.observations.emplace_back();
      seen.pose = k;
      seen.camera = v % 2;
    }
  return data;
}

// The views of camera 0 in an image share part of their variance, which continues from image to
// image by `as_before`; all other errors are independent. `kept`: share of all errors that a fit
// leaves.
std::vector<double> ratios(double share, double as_before, int images = 4000, double kept = 1.0) {
  const ViewData data = two_cameras(images);
  ImageScatter scatter(data, kScatterDraws);
  Random random(4);
  double common = random.normal();
  // Columns of zero, small and large size, with signs that vary between views.
  Eigen::RowVectorXd columns(static_cast<Eigen::Index>(kCameraColumns.size()));
  for (std::size_t o = 0; o < data.bundle.observations.size(); ++o) {
    if (o % (2 * kScatterViews) == 0)
      common = as_before * common + std::sqrt(1.0 - as_before * as_before) * random.normal();
    columns.setZero();
    columns.head<7>() << 0.0, 1.0, 1.0, 30.0, 0.1, 2.0, 3.0;
    Eigen::RowVectorXd left(1 + kScatterDraws);
    for (double& x : left) x = random.normal();
    if (data.bundle.observations[o].camera == 0)
      left[0] = std::sqrt(share) * common + std::sqrt(1.0 - share) * left[0];
    scatter.add(o, kept * left, columns);
  }
  return scatter.ratios();
}

TEST(ImageScatter, OfIndependentErrorsIsOne) {
  EXPECT_EQ(ratios(0.0, 0.0), (std::vector<double>{1.0, 1.0}));
}

// Three views an image with a quarter of common variance: 1 + 2 / 4.
TEST(ImageScatter, OfOneCameraIsThatOfItsAutocorrelation) {
  const auto alone = ratios(0.25, 0.0, 40000);
  EXPECT_NEAR(alone[0], 1.5, 0.15);
  EXPECT_EQ(alone[1], 1.0);
  const auto on = ratios(0.25, 0.8, 40000);
  double expected = 1.5;
  for (int lag = 1; lag < ImageScatter::kImagesAlike; ++lag)
    expected += 2.0 * kScatterViews * 0.25 * std::pow(0.8, lag) *
                (1.0 - lag / static_cast<double>(ImageScatter::kImagesAlike));
  EXPECT_NEAR(on[0], expected, 0.15 * expected);
  EXPECT_EQ(on[1], 1.0);
}

// Relative to draws that the fit reduces by the same factor.
TEST(ImageScatter, DoesNotDependOnTheScaleOfTheErrors) {
  const auto whole = ratios(0.25, 0.8);
  const auto small = ratios(0.25, 0.8, 4000, 0.1);
  EXPECT_NEAR(whole[0], small[0], 1e-9 * whole[0]);
}

TEST(ImageScatter, OfErrorsThatAlternateIsNotLessThanOne) { EXPECT_EQ(ratios(0.9, -0.9)[0], 1.0); }

// 30 images give one window only.
TEST(ImageScatter, OfFewImagesIsSeldomTakenFromChance) {
  const ViewData data = two_cameras(30);
  int taken = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    ImageScatter scatter(data, kScatterDraws);
    Random random(seed);
    Eigen::RowVectorXd columns(static_cast<Eigen::Index>(kCameraColumns.size()));
    Eigen::RowVectorXd left(1 + kScatterDraws);
    for (std::size_t o = 0; o < data.bundle.observations.size(); ++o) {
      for (double& x : columns) x = random.normal();
      for (double& x : left) x = random.normal();
      scatter.add(o, left, columns);
    }
    for (const double ratio : scatter.ratios()) taken += ratio > 1.0 ? 1 : 0;
  }
  EXPECT_LE(taken, 12);  // of 400
}

TEST(ImageScatter, OfCamerasThatSawNothingIsOne) {
  const ViewData data = two_cameras(10);
  EXPECT_EQ(ImageScatter(data, kScatterDraws).ratios(), (std::vector<double>{1.0, 1.0}));
}

}  // namespace
}  // namespace roadbook
