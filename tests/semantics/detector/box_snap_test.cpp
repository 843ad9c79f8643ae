#include "semantics/detector/box_snap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

constexpr double kTilt = 0.3;  // of the rows in the image

// Spaces of 5 x 2.5 m in a row that is tilted in the image. Lines are between the spaces and at
// their ends on one side. The whole image has grain.
GroundImage painted_row() {
  GroundImage image;
  image.resolution_m = 0.04;
  image.corner = {-2.0, 12.0};
  image.grey = cv::Mat(500, 700, CV_8U);
  image.seen = cv::Mat(500, 700, CV_8U, cv::Scalar(255));
  Random random(1, "grain");
  for (int row = 0; row < image.grey.rows; ++row)
    for (int column = 0; column < image.grey.cols; ++column) {
      const double x = image.corner.x() + (column + 0.5) * image.resolution_m;
      const double y = image.corner.y() - (row + 0.5) * image.resolution_m;
      const double along = std::cos(kTilt) * x + std::sin(kTilt) * y;
      const double across = -std::sin(kTilt) * x + std::cos(kTilt) * y;
      const bool in_row = across > 0.0 && across < 5.06;
      const bool line = in_row && (std::abs(std::remainder(along, 2.5)) < 0.06 || across > 4.94);
      image.grey.at<std::uint8_t>(row, column) =
          static_cast<std::uint8_t>((line ? 170.0 : 90.0) + 12.0 * random.uniform());
    }
  return image;
}

OrientedBox space(int i) {
  const Eigen::Vector2d p((i + 0.5) * 2.5, 2.5);
  return {{std::cos(kTilt) * p.x() - std::sin(kTilt) * p.y(),
           std::sin(kTilt) * p.x() + std::cos(kTilt) * p.y()},
          kTilt + 0.5 * M_PI,
          5.0,
          2.5};
}

TEST(BoxSnap, PutsABoxThatIsBesideItsLinesOnThem) {
  const GroundImage image = painted_row();
  Random random(2, "boxes");
  double worst_m = 0.0;
  double worst_rad = 0.0;
  for (int i = 0; i < 40; ++i) {
    const OrientedBox want = space(1 + i % 5);
    OrientedBox box = want;
    box.centre += Eigen::Vector2d(random.uniform(-0.25, 0.25), random.uniform(-0.25, 0.25));
    box.heading += random.uniform(-0.08, 0.08);
    box.width_m += random.uniform(-0.15, 0.15);
    const OrientedBox got = snapped(image, box);
    worst_m = std::max(worst_m, (got.centre - want.centre).norm());
    worst_rad = std::max(worst_rad, std::abs(got.heading - want.heading));
  }
  // A pixel is 4 cm wide; a line is 12 cm wide.
  EXPECT_LT(worst_m, 0.08);
  EXPECT_LT(worst_rad, 0.025);
  EXPECT_GT(paint_along(image, space(2)), 0.8);
}

TEST(BoxSnap, LeavesABoxWithoutPaintAloneAndOnePaintedSideIsEnough) {
  GroundImage image = painted_row();
  const OrientedBox far_off{{18.0, -4.0}, 0.4, 5.0, 2.5};
  const OrientedBox same = snapped(image, far_off);
  EXPECT_EQ(same.centre, far_off.centre);
  EXPECT_EQ(same.heading, far_off.heading);
  EXPECT_EQ(same.width_m, far_off.width_m);
  // A car's shadow over the space and one of its lines.
  const OrientedBox want = space(3);
  for (int row = 0; row < image.grey.rows; ++row)
    for (int column = 0; column < image.grey.cols; ++column) {
      const double x = image.corner.x() + (column + 0.5) * image.resolution_m;
      const double y = image.corner.y() - (row + 0.5) * image.resolution_m;
      const double along = std::cos(kTilt) * x + std::sin(kTilt) * y;
      if (along > 7.2 && along < 9.8) image.grey.at<std::uint8_t>(row, column) = 40;
    }
  OrientedBox box = want;
  box.centre.x() += 0.2;
  const OrientedBox got = snapped(image, box);
  const Eigen::Vector2d across(std::cos(kTilt), std::sin(kTilt));
  EXPECT_LT(std::abs((got.centre - want.centre).dot(across)), 0.08);
  EXPECT_EQ(got.width_m, box.width_m);
}

TEST(BoxSnap, RefusesOptionsThatMakeNoSense) {
  EXPECT_THROW(static_cast<void>(snapped(painted_row(), space(1), {.reach_m = -1.0})),
               InvalidOption);
}

// Computes the definition of the header point by point.
double paint_by_hand(const GroundImage& image, const OrientedBox& box, double side) {
  const auto grey = [&](const Eigen::Vector2d& p) -> double {
    const int column = static_cast<int>(std::lround(image.pixel_of(p).x()));
    const int row = static_cast<int>(std::lround(image.pixel_of(p).y()));
    const bool in = column >= 0 && row >= 0 && column < image.grey.cols && row < image.grey.rows;
    return in && image.seen.at<std::uint8_t>(row, column) != 0
               ? image.grey.at<std::uint8_t>(row, column)
               : -1.0;
  };
  const Eigen::Vector2d along(std::cos(box.heading), std::sin(box.heading));
  const Eigen::Vector2d outward = side * Eigen::Vector2d(-along.y(), along.x());
  double sum = 0.0;
  for (int i = 0; i < 32; ++i) {
    const Eigen::Vector2d p =
        box.centre + 0.5 * box.width_m * outward + ((i + 0.5) / 32 - 0.5) * box.length_m * along;
    const double here = grey(p);
    const double in = grey(p - 0.2 * outward);
    const double out = grey(p + 0.2 * outward);
    if (here >= 0.0 && in >= 0.0 && out >= 0.0)
      sum += std::clamp((here - std::max(in, out)) / 30.0, 0.0, 1.0);
  }
  return sum / 32;
}

TEST(BoxSnap, FindsThePaintThatIsThereAlsoWhereThePictureEnds) {
  GroundImage image = painted_row();
  image.seen(cv::Rect(300, 150, 90, 200)) = 0;
  Random random(3, "boxes");
  int with_paint = 0;
  for (int i = 0; i < 300; ++i) {
    OrientedBox box = space(i % 10 - 1);
    box.centre += Eigen::Vector2d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
    box.heading += random.uniform(-0.05, 0.05);
    const double want = std::max(paint_by_hand(image, box, 1.0), paint_by_hand(image, box, -1.0));
    // A point on the border of two pixels may belong to either pixel.
    EXPECT_NEAR(paint_along(image, box), want, 1.0 / 32) << i;
    with_paint += want > 0.1 ? 1 : 0;
  }
  EXPECT_GT(with_paint, 30);
}

TEST(BoxSnap, PutsManyBoxesWhereItPutsEachOnAnyNumberOfThreads) {
  const GroundImage image = painted_row();
  Random random(4, "boxes");
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 30; ++i) {
    boxes.push_back(space(1 + i % 5));
    boxes.back().centre += Eigen::Vector2d(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
  }
  const PaintPicture picture(image);
  const auto one = all_snapped(picture, boxes, 1);
  const auto four = all_snapped(picture, boxes, 4);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const OrientedBox& got : {four[i], snapped(image, boxes[i])}) {
      EXPECT_EQ(one[i].centre, got.centre);
      EXPECT_EQ(one[i].heading, got.heading);
      EXPECT_EQ(one[i].width_m, got.width_m);
    }
}

}  // namespace
}  // namespace roadbook
