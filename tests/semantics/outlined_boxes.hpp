#pragma once

#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/random.hpp"
#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook::test {

/// A picture of rough ground, 80 by 60 m at 0.1 m, with boxes of 5 by 2.5 m outlined on it.
struct OutlinedBoxes {
  GroundImage image;
  std::vector<OrientedBox> spaces;
};

inline void paint_outline(const OrientedBox& box, GroundImage& image) {
  std::vector<cv::Point> polygon;
  constexpr int kShift = 4;
  for (const auto& corner : box.corners()) {
    const Eigen::Vector2d p = image.pixel_of(corner) * (1 << kShift);
    polygon.emplace_back(static_cast<int>(p.x()), static_cast<int>(p.y()));
  }
  cv::polylines(image.grey, polygon, true, cv::Scalar(210), 2, cv::LINE_AA, kShift);
}

/// At any place and heading, a metre or more from one another.
inline OutlinedBoxes outlined_boxes(int count, std::uint64_t seed) {
  Random random(seed, "lot");
  OutlinedBoxes lot;
  lot.image.grey = cv::Mat(600, 800, CV_8U);
  for (int row = 0; row < lot.image.grey.rows; ++row)
    for (int column = 0; column < lot.image.grey.cols; ++column)
      lot.image.grey.at<unsigned char>(row, column) =
          cv::saturate_cast<unsigned char>(95.0 + 12.0 * random.normal());
  lot.image.seen = cv::Mat(lot.image.grey.size(), CV_8U, cv::Scalar(255));
  lot.image.corner = {-10.0, 50.0};
  lot.image.resolution_m = 0.1;
  while (static_cast<int>(lot.spaces.size()) < count) {
    const OrientedBox box{{random.uniform(-5.0, 65.0), random.uniform(-5.0, 45.0)},
                          random.uniform(-std::numbers::pi, std::numbers::pi),
                          5.0,
                          2.5};
    OrientedBox wide = box;
    wide.length_m += 2.0;
    wide.width_m += 2.0;
    bool free = true;
    for (const auto& other : lot.spaces) free = free && intersection_over_union(wide, other) == 0.0;
    if (!free) continue;
    lot.spaces.push_back(box);
    paint_outline(box, lot.image);
  }
  return lot;
}

}  // namespace roadbook::test
