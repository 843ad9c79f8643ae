#include "vo/corners.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/features2d.hpp>

namespace roadbook {
namespace {

constexpr int kCircle = 16;
constexpr int kArc = 9;
constexpr std::array<std::array<int, 2>, kCircle> kOffsets{{{0, 3},
                                                            {1, 3},
                                                            {2, 2},
                                                            {3, 1},
                                                            {3, 0},
                                                            {3, -1},
                                                            {2, -2},
                                                            {1, -3},
                                                            {0, -3},
                                                            {-1, -3},
                                                            {-2, -2},
                                                            {-3, -1},
                                                            {-3, 0},
                                                            {-3, 1},
                                                            {-2, 2},
                                                            {-1, 3}}};

}  // namespace

int corner_score(const cv::Mat& image, int x, int y) {
  const int middle = image.at<std::uint8_t>(y, x);
  std::array<int, kCircle + kArc - 1> difference{};
  for (std::size_t i = 0; i < difference.size(); ++i) {
    const auto& [dx, dy] = kOffsets[i % kCircle];
    difference[i] = image.at<std::uint8_t>(y + dy, x + dx) - middle;
  }
  int score = 0;
  for (std::size_t start = 0; start < kCircle; ++start) {
    const auto arc = difference.begin() + static_cast<std::ptrdiff_t>(start);
    const auto [least, most] = std::minmax_element(arc, arc + kArc);
    score = std::max({score, *least, -*most});
  }
  return std::max(0, score - 1);  // "brighter than middle + threshold", strictly
}

std::vector<cv::KeyPoint> find_corners(const cv::Mat& image, int threshold) {
  std::vector<cv::KeyPoint> corners;
  cv::FAST(image, corners, threshold, true, cv::FastFeatureDetector::TYPE_9_16);
  return corners;
}

cv::Point2f refine_corner(const cv::Mat& image, const cv::Point2f& corner) {
  const int x = cvRound(corner.x);
  const int y = cvRound(corner.y);
  if (x < 4 || y < 4 || x >= image.cols - 4 || y >= image.rows - 4) return corner;
  std::array<std::array<double, 3>, 3> s{};  // [row][column]
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      s[static_cast<std::size_t>(dy + 1)][static_cast<std::size_t>(dx + 1)] =
          corner_score(image, x + dx, y + dy);
  // Least squares of a + gx x + gy y + (hxx x^2 + hyy y^2) / 2 + hxy x y over the nine pixels.
  double gx = 0.0;
  double gy = 0.0;
  double hxx = 0.0;
  double hyy = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    gx += (s[i][2] - s[i][0]) / 6.0;
    gy += (s[2][i] - s[0][i]) / 6.0;
    hxx += (s[i][0] - 2.0 * s[i][1] + s[i][2]) / 3.0;
    hyy += (s[0][i] - 2.0 * s[1][i] + s[2][i]) / 3.0;
  }
  const double hxy = (s[2][2] - s[2][0] - s[0][2] + s[0][0]) / 4.0;
  const double determinant = hxx * hyy - hxy * hxy;
  if (!(hxx < 0.0) || !(determinant > 1e-9)) return corner;  // no peak
  const double dx = (-hyy * gx + hxy * gy) / determinant;
  const double dy = (hxy * gx - hxx * gy) / determinant;
  return {static_cast<float>(x + std::clamp(dx, -1.0, 1.0)),
          static_cast<float>(y + std::clamp(dy, -1.0, 1.0))};
}

}  // namespace roadbook
