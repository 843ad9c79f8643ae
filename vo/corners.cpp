#include "vo/corners.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/features2d.hpp>

#include "base/target_clones.hpp"

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

// Scores of `count` pixels in a row, from `at`. Arcs of 9 are made of those of 2, 4 and 8.
ROADBOOK_CLONES void score_row(const std::uint8_t* at,
                               std::ptrdiff_t step,
                               int count,
                               std::int16_t* scores) {
  constexpr std::size_t kTwice = 2 * kCircle;  // the circle again after its end
  for (int k = 0; k < count; ++k, ++at) {
    alignas(32) std::int16_t difference[kTwice];
    for (std::size_t i = 0; i < kCircle; ++i) {
      const auto& [dx, dy] = kOffsets[i];
      difference[i] = static_cast<std::int16_t>(at[dy * step + dx] - *at);
    }
    for (std::size_t i = 0; i < kCircle; ++i) difference[i + kCircle] = difference[i];
    alignas(32) std::int16_t least[kTwice];
    alignas(32) std::int16_t most[kTwice];
    for (std::size_t i = 0; i < 24; ++i) {
      least[i] = std::min(difference[i], difference[i + 1]);
      most[i] = std::max(difference[i], difference[i + 1]);
    }
    alignas(32) std::int16_t least4[kTwice];
    alignas(32) std::int16_t most4[kTwice];
    for (std::size_t i = 0; i < 20; ++i) {
      least4[i] = std::min(least[i], least[i + 2]);
      most4[i] = std::max(most[i], most[i + 2]);
    }
    std::int16_t score = 0;
    for (std::size_t i = 0; i < kCircle; ++i) {
      const std::int16_t brighter =
          std::min(std::min(least4[i], least4[i + 4]), difference[i + kArc - 1]);
      const std::int16_t darker =
          std::max(std::max(most4[i], most4[i + 4]), difference[i + kArc - 1]);
      const auto depth = static_cast<std::int16_t>(-darker);
      score = std::max(score, std::max(brighter, depth));
    }
    // "brighter than middle + threshold", strictly
    scores[k] = std::max(std::int16_t{0}, static_cast<std::int16_t>(score - 1));
  }
}

}  // namespace

int corner_score(const cv::Mat& image, int x, int y) {
  std::int16_t score = 0;
  score_row(image.ptr<std::uint8_t>(y) + x, static_cast<std::ptrdiff_t>(image.step[0]), 1, &score);
  return score;
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
  for (std::size_t row = 0; row < 3; ++row) {
    std::array<std::int16_t, 3> scores{};
    score_row(image.ptr<std::uint8_t>(y + static_cast<int>(row) - 1) + x - 1,
              static_cast<std::ptrdiff_t>(image.step[0]), 3, scores.data());
    for (std::size_t column = 0; column < 3; ++column) s[row][column] = scores[column];
  }
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
