#include "vo/corners.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numbers>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

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

// The reference is BRISK's own, slower detector, with the same arcs. Its parabola may move a corner
// by one pixel in each direction.
TEST(Corners, AreFoundAtThePixelsOfBrisk) {
  const cv::Mat image = speckled(2);
  std::vector<cv::KeyPoint> judged;
  cv::BRISK::create(20, 0)->detect(image, judged);
  const auto corners = find_corners(image, 20);
  ASSERT_GT(judged.size(), 100U);
  std::size_t found = 0;
  for (const auto& k : judged)
    found += std::any_of(corners.begin(), corners.end(), [&](const cv::KeyPoint& c) {
      return std::abs(c.pt.x - k.pt.x) <= 1.0F && std::abs(c.pt.y - k.pt.y) <= 1.0F;
    });
  // If two neighbours have the same strength, FAST keeps neither.
  EXPECT_GT(static_cast<double>(found), 0.85 * static_cast<double>(judged.size()));
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

// A corner of two straight edges: the mean of 6 x 6 points in each pixel, smoothed as a lens does.
// `middle`: direction of its bisector [rad]; `opening`: half of its angle [rad].
cv::Mat straight_corner(const cv::Point2d& tip, double middle, double opening, bool bright) {
  constexpr int kParts = 6;
  cv::Mat image(40, 40, CV_32FC1);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) {
      int inside = 0;
      for (int i = 0; i < kParts * kParts; ++i) {
        const double x = u - 0.5 + (i % kParts + 0.5) / kParts - tip.x;
        const double y = v - 0.5 + (i / kParts + 0.5) / kParts - tip.y;
        const double away = std::remainder(std::atan2(y, x) - middle, 2.0 * std::numbers::pi);
        inside += std::abs(away) < opening ? 1 : 0;
      }
      const float share = static_cast<float>(inside) / (kParts * kParts);
      image.at<float>(v, u) = bright ? 60.0F + 120.0F * share : 180.0F - 120.0F * share;
    }
  cv::GaussianBlur(image, image, cv::Size(0, 0), 0.6);
  image.convertTo(image, CV_8U);
  return image;
}

// The strongest pixel lies inside a corner, as many pixels from afar as from near. Where the edges
// meet is a place of the object.
TEST(Corners, OfStraightEdgesLieNearWhereTheyMeet) {
  Random random(5, "straight corners");
  double strongest_px = 0.0;  // farther inside than the tip, in the mean
  double refined_px = 0.0;
  int count = 0;
  for (int i = 0; i < 100; ++i) {
    const cv::Point2d tip(random.uniform(18.0, 22.0), random.uniform(18.0, 22.0));
    const double middle = random.uniform(0.0, 2.0 * std::numbers::pi);
    const cv::Mat image = straight_corner(tip, middle, random.uniform(0.6, 0.85), i % 2 == 0);
    const auto corners = find_corners(image, 20);
    const auto inside = [&](const cv::Point2f& p) {
      return (p.x - tip.x) * std::cos(middle) + (p.y - tip.y) * std::sin(middle);
    };
    for (const auto& c : corners) {
      if (std::hypot(c.pt.x - tip.x, c.pt.y - tip.y) > 4.0) continue;
      strongest_px += inside(c.pt);
      refined_px += inside(refine_corner(image, c.pt));
      ++count;
    }
  }
  ASSERT_GT(count, 60);
  std::printf("inside the tip: strongest pixel %.2f px, refined %.2f px, of %d\n",
              strongest_px / count, refined_px / count, count);
  EXPECT_GT(strongest_px / count, 1.0);
  EXPECT_LT(refined_px / count, 0.5 * strongest_px / count);
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
