#include "vo/brisk_description.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/random.hpp"

namespace roadbook {
namespace {

// Noise of several sizes, so that boxes of every size see edges.
cv::Mat noisy_image(int width, int height, std::uint64_t seed) {
  Random random(seed, "brisk");
  cv::Mat sum(height, width, CV_32F, cv::Scalar(0));
  for (const int cell : {1, 3, 9, 27}) {
    cv::Mat coarse(height / cell + 2, width / cell + 2, CV_32F);
    for (int y = 0; y < coarse.rows; ++y)
      for (int x = 0; x < coarse.cols; ++x)
        coarse.at<float>(y, x) = static_cast<float>(random.uniform(-60.0, 60.0));
    cv::Mat fine;
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_LINEAR);
    sum += fine;
  }
  cv::Mat image;
  sum.convertTo(image, CV_8U, 1.0, 128.0);
  return image;
}

// OpenCV judges: the same corners are described, with the same bits.
TEST(BriskDescription, IsThatOfOpenCvBitForBit) {
  const cv::Ptr<cv::BRISK> brisk = cv::BRISK::create(30, 0);
  std::size_t described = 0;
  std::size_t left_out = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const cv::Mat image = noisy_image(300 + 7 * static_cast<int>(seed), 200, seed);
    Random random(seed, "corners");
    std::vector<cv::Point2f> corners;
    for (int k = 0; k < 500; ++k) {
      const double x = random.uniform(0.0, image.cols - 1.0);
      const double y = random.uniform(0.0, image.rows - 1.0);
      // Every fourth at whole and half pixels, where boxes end between two pixels.
      corners.emplace_back(static_cast<float>(k % 4 == 0 ? std::round(2.0 * x) / 2.0 : x),
                           static_cast<float>(k % 4 == 0 ? std::round(2.0 * y) / 2.0 : y));
    }
    std::vector<cv::KeyPoint> judged;
    for (const cv::Point2f& corner : corners) judged.emplace_back(corner, 12.0F);
    cv::Mat want;
    brisk->compute(image, judged, want);
    const DescribedCorners got = describe_corners(image, corners);
    ASSERT_EQ(got.corners.size(), judged.size());
    ASSERT_EQ(got.descriptors.size(), judged.size());
    for (std::size_t i = 0; i < judged.size(); ++i) {
      EXPECT_EQ(corners[static_cast<std::size_t>(got.corners[i])], judged[i].pt);
      EXPECT_EQ(std::memcmp(got.descriptors[i].data(), want.ptr(static_cast<int>(i)), 64), 0)
          << judged[i].pt << " in image " << seed;
    }
    described += judged.size();
    left_out += corners.size() - judged.size();
  }
  EXPECT_GT(described, 3000U);
  EXPECT_GT(left_out, 1000U);
}

TEST(BriskDescription, OfAPartOfAnImageIsThatOfItsCopy) {
  const cv::Mat image = noisy_image(200, 160, 1);
  const cv::Mat part = image(cv::Rect(11, 7, 150, 120));
  const std::vector<cv::Point2f> corners{{60.25F, 50.5F}, {80.75F, 40.0F}};
  const DescribedCorners a = describe_corners(part, corners);
  const DescribedCorners b = describe_corners(part.clone(), corners);
  ASSERT_EQ(a.corners.size(), 2U);
  EXPECT_EQ(a.descriptors, b.descriptors);
}

TEST(BriskDescription, OfNoCornersAndOfATinyImageIsEmpty) {
  EXPECT_TRUE(describe_corners(noisy_image(100, 100, 2), {}).corners.empty());
  const std::vector<cv::Point2f> corners{{8.0F, 8.0F}};
  EXPECT_TRUE(describe_corners(noisy_image(16, 16, 3), corners).corners.empty());
}

}  // namespace
}  // namespace roadbook
