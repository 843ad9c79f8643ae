#include "vo/corners.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"
#include "base/random.hpp"
#include "vo/features.hpp"

namespace roadbook {
namespace {

cv::Mat speckled(std::uint64_t seed) {
  Random random(seed);
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(90));
  for (int i = 0; i < 150; ++i) {
    const cv::Point middle(static_cast<int>(random.below(320)),
                           static_cast<int>(random.below(240)));
    const auto grey = static_cast<double>(random.below(256));
    cv::rectangle(image, middle, middle + cv::Point(5 + static_cast<int>(random.below(15)), 9),
                  cv::Scalar(grey), cv::FILLED);
  }
  cv::GaussianBlur(image, image, {3, 3}, 0.8);
  return image;
}

// OpenCV's FAST computes the strength of its corners by a separate binary search.
TEST(Corners, StrengthsAreThoseOfOpenCv) {
  const cv::Mat image = speckled(1);
  const auto corners = find_corners(image, 15);
  ASSERT_GT(corners.size(), 100U);
  for (const auto& c : corners)
    EXPECT_EQ(corner_score(image, cvRound(c.pt.x), cvRound(c.pt.y)), cvRound(c.response));
}

// The reference is BRISK's own, slower detector, with the same arcs and the same parabola.
TEST(Corners, LieWhereBriskFindsThem) {
  const cv::Mat image = speckled(2);
  std::vector<cv::KeyPoint> judged;
  cv::BRISK::create(20, 0)->detect(image, judged);
  const auto corners = find_corners(image, 20);
  ASSERT_GT(judged.size(), 100U);
  std::size_t found = 0;
  double sum_px = 0.0;
  for (const auto& k : judged) {
    double nearest = 1.0;
    for (const auto& c : corners) {
      const cv::Point2f p = refine_corner(image, c.pt);
      nearest = std::min(nearest, static_cast<double>(std::hypot(p.x - k.pt.x, p.y - k.pt.y)));
    }
    if (nearest >= 1.0) continue;
    ++found;
    sum_px += nearest;
  }
  // If two neighbours have the same strength, FAST keeps neither.
  EXPECT_GT(static_cast<double>(found), 0.85 * static_cast<double>(judged.size()));
  EXPECT_LT(sum_px / static_cast<double>(found), 0.1);
}

// A round spot moved by a known part of a pixel.
TEST(Corners, FollowAMoveOfPartOfAPixel) {
  const auto spot_at = [](double x) {
    cv::Mat image(40, 40, CV_8UC1);
    for (int v = 0; v < 40; ++v)
      for (int u = 0; u < 40; ++u)
        image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
            40.0 + 160.0 * std::exp(-((u - x) * (u - x) + (v - 20.2) * (v - 20.2)) / 4.5));
    const auto corners = find_corners(image, 20);
    EXPECT_EQ(corners.size(), 1U);
    return corners.empty() ? cv::Point2f() : refine_corner(image, corners.front().pt);
  };
  for (const double x : {20.0, 20.2, 20.4, 20.6, 20.9}) {
    EXPECT_NEAR(spot_at(x).x, x, 0.15);  // the strength is no perfect parabola
    EXPECT_NEAR(spot_at(x).y, 20.2, 0.15);
  }
}

TEST(Features, KeepWithinMaskBorderAndQuota) {
  const cv::Mat image = speckled(3);
  cv::Mat mask(image.size(), CV_8UC1, cv::Scalar(255));
  mask.colRange(0, 160).setTo(0);
  FeatureOptions options;
  options.max_features = 60;
  options.max_per_cell = 2;
  const Features features = detect_features(image, mask, options);
  ASSERT_GT(features.size(), 20U);
  EXPECT_LE(features.size(), 60U);
  ASSERT_EQ(features.descriptors.size(), features.size());
  std::map<std::pair<int, int>, int> cells;
  for (const auto& p : features.pixels) {
    EXPECT_GT(p.x(), 158.0F);  // refined by one pixel at most
    EXPECT_LT(p.y(), 240.0F - 10.0F);
    ++cells[{static_cast<int>(p.x()) / 32, static_cast<int>(p.y()) / 32}];
  }
  // Refinement may carry a corner over the border of its cell.
  for (const auto& [cell, count] : cells) EXPECT_LE(count, 4);
}

// All speckles lie in nine cells, each of which gives two corners. Descriptions need 20 px from the
// image border.
TEST(Features, CrowdedInFewCellsAreStillManyEnough) {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(128));
  cv::Mat small;
  cv::resize(speckled(7), small, {160, 120}, 0.0, 0.0, cv::INTER_AREA);
  small(cv::Rect(40, 20, 64, 64)).copyTo(image(cv::Rect(14, 60, 64, 64)));
  FeatureOptions options;
  options.max_per_cell = 2;
  const Features spread = detect_features(image, {}, options);
  options.fewest = 24;
  const Features enough = detect_features(image, {}, options);
  EXPECT_LT(spread.size(), 20U);
  EXPECT_GE(enough.size(), 23U);  // refinement may carry one over the border
  // No more than the last corner of each cell that was needed.
  EXPECT_LE(enough.size(), 33U);
  options.fewest = options.max_features;
  const std::size_t all = detect_features(image, {}, options).size();
  EXPECT_GT(all, enough.size());
  EXPECT_LT(all, static_cast<std::size_t>(options.max_features));
  options.fewest = options.max_features + 1;
  EXPECT_THROW((void)detect_features(image, {}, options), InvalidOption);
}

TEST(Features, OfAPlainImageAreNone) {
  EXPECT_EQ(detect_features(cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)), {}).size(), 0U);
}

// An image turned by half a turn shows the same corners: their descriptors must agree.
TEST(Features, DescriptorsDoNotDependOnTheDirection) {
  const cv::Mat image = speckled(4);
  cv::Mat turned;
  cv::rotate(image, turned, cv::ROTATE_180);
  const Features a = detect_features(image, {});
  const Features b = detect_features(turned, {});
  int together = 0;
  int alike = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector2f there(319.0F - a.pixels[i].x(), 239.0F - a.pixels[i].y());
    for (std::size_t j = 0; j < b.size(); ++j) {
      if ((b.pixels[j] - there).norm() > 0.5F) continue;
      ++together;
      alike += hamming(a.descriptors[i], b.descriptors[j]) < 100 ? 1 : 0;
    }
  }
  EXPECT_GT(together, 50);
  EXPECT_GT(alike, 9 * together / 10);
}

}  // namespace
}  // namespace roadbook
