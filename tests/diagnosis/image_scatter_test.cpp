#include "diagnosis/image_scatter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr int kImages = 4000;

// One view an image of each of two cameras.
ViewData two_cameras() {
  ViewData data;
  data.bundle.cameras.resize(2);
  data.bundle.poses.resize(kImages);
  for (int k = 0; k < kImages; ++k)
    for (int c = 0; c < 2; ++c) {
      BundleObservation& seen = data.bundle.observations.emplace_back();
      seen.pose = k;
      seen.camera = c;
    }
  return data;
}

// Of camera 0 errors that go on from image to image by `as_before`, of camera 1 independent ones.
std::vector<double> ratios(double as_before) {
  const ViewData data = two_cameras();
  ImageScatter scatter(data);
  Random random(4);
  double wanders = random.normal();
  const Eigen::RowVectorXd columns =
      Eigen::RowVectorXd::Constant(static_cast<Eigen::Index>(kCameraColumns.size()), 3.0);
  for (std::size_t o = 0; o < data.bundle.observations.size(); ++o) {
    if (data.bundle.observations[o].camera == 0)
      wanders = as_before * wanders + std::sqrt(1.0 - as_before * as_before) * random.normal();
    const double error = data.bundle.observations[o].camera == 0 ? wanders : random.normal();
    scatter.add(o, error, columns);
  }
  return scatter.ratios();
}

TEST(ImageScatter, OfIndependentErrorsIsOne) {
  for (const double ratio : ratios(0.0)) EXPECT_NEAR(ratio, 1.0, 0.3);
}

TEST(ImageScatter, OfOneCameraIsThatOfItsAutocorrelation) {
  const auto both = ratios(0.8);
  double expected = 1.0;
  for (int lag = 1; lag < ImageScatter::kImagesAlike; ++lag)
    expected +=
        2.0 * std::pow(0.8, lag) * (1.0 - lag / static_cast<double>(ImageScatter::kImagesAlike));
  EXPECT_NEAR(both[0], expected, 0.25 * expected);
  EXPECT_NEAR(both[1], 1.0, 0.3);
}

TEST(ImageScatter, OfErrorsThatAlternateIsNotLessThanOne) { EXPECT_EQ(ratios(-0.9)[0], 1.0); }

TEST(ImageScatter, OfACameraThatSawNothingIsOne) {
  const ViewData data = two_cameras();
  EXPECT_EQ(ImageScatter(data).ratios(), (std::vector<double>{1.0, 1.0}));
}

}  // namespace
}  // namespace roadbook
