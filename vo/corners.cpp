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
constexpr int kReach = 2;  // of the gradients around a corner [px]
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

// The peak of the parabola through the strengths of the 3 x 3 pixels around a corner, at most one
// pixel away (Leutenegger, Chli, Siegwart 2011, section 3.1).
cv::Point2f strongest_point(const cv::Mat& image, const cv::Point2f& corner) {
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

// Foerstner's normal equations of one kind of point: where edges meet, along the gradients g, or
// the middle of a round spot, across them.
struct PointEquations {
  double xx = 0.0;  // of g g^T
  double xy = 0.0;
  double yy = 0.0;
  double x = 0.0;  // of g g^T times the way from the corner
  double y = 0.0;
  double squares = 0.0;  // of the parts of the ways along g

  void add(double weight, double gx, double gy, double dx, double dy) {
    const double along = gx * dx + gy * dy;
    xx += weight * gx * gx;
    xy += weight * gx * gy;
    yy += weight * gy * gy;
    x += weight * along * gx;
    y += weight * along * gy;
    squares += weight * along * along;
  }
  // The squares that are left at the solution.
  [[nodiscard]] double left() const {
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.0)) return squares;
    return squares - (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
  }
};
struct CornerEquations {
  PointEquations edges;
  PointEquations spot;
};

// Sums over the pixels around `corner`, weighted by nearness.
CornerEquations equations_of(const cv::Mat& image, const cv::Point2f& corner) {
  const int middle_x = cvRound(corner.x);
  const int middle_y = cvRound(corner.y);
  // Close to a normal distribution of 1.25 px, by sums and products alone: the same bits
  // everywhere.
  const auto weight = [](double away) {
    const double rest = std::max(0.0, 1.0 - away * away / 8.0);
    return rest * rest;
  };
  CornerEquations equations;
  for (int y = middle_y - kReach; y <= middle_y + kReach; ++y) {
    const std::uint8_t* above = image.ptr<std::uint8_t>(y - 1);
    const std::uint8_t* at = image.ptr<std::uint8_t>(y);
    const std::uint8_t* below = image.ptr<std::uint8_t>(y + 1);
    const double dy = y - static_cast<double>(corner.y);
    for (int x = middle_x - kReach; x <= middle_x + kReach; ++x) {
      const double dx = x - static_cast<double>(corner.x);
      // Scharr's gradient.
      const double gx = 3 * (above[x + 1] - above[x - 1] + below[x + 1] - below[x - 1]) +
                        10 * (at[x + 1] - at[x - 1]);
      const double gy = 3 * (below[x - 1] - above[x - 1] + below[x + 1] - above[x + 1]) +
                        10 * (below[x] - above[x]);
      const double w = weight(dx) * weight(dy);
      equations.edges.add(w, gx, gy, dx, dy);
      equations.spot.add(w, -gy, gx, dx, dy);
    }
  }
  return equations;
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
  constexpr int kRounds = 3;
  constexpr float kFarthest = 2.0F;  // from the strongest point [px]
  // Share of all gradients that holds a corner at its strongest point, in every direction: along an
  // edge nothing else does. Poses of simulated drives were best with it (0.05 to 0.5 tried).
  constexpr double kHeld = 0.2;
  constexpr double kSpot = 0.1;  // of the squares that edges leave: below it, a round spot
  const cv::Point2f strongest = strongest_point(image, corner);
  cv::Point2f meeting = strongest;
  bool is_spot = false;
  for (int round = 0; round < kRounds; ++round) {
    constexpr float kMargin = kReach + 1.0F;
    if (meeting.x < kMargin || meeting.y < kMargin ||
        meeting.x > static_cast<float>(image.cols - 1) - kMargin ||
        meeting.y > static_cast<float>(image.rows - 1) - kMargin)
      return strongest;
    const CornerEquations equations = equations_of(image, meeting);
    if (round == 0) is_spot = equations.spot.left() < kSpot * equations.edges.left();
    PointEquations g = is_spot ? equations.spot : equations.edges;
    const double held = kHeld * (g.xx + g.yy);
    if (!(held > 0.0)) return strongest;
    g.xx += held;
    g.yy += held;
    g.x += held * static_cast<double>(strongest.x - meeting.x);
    g.y += held * static_cast<double>(strongest.y - meeting.y);
    const double determinant = g.xx * g.yy - g.xy * g.xy;
    meeting.x += static_cast<float>((g.yy * g.x - g.xy * g.y) / determinant);
    meeting.y += static_cast<float>((g.xx * g.y - g.xy * g.x) / determinant);
    const cv::Point2f away = meeting - strongest;
    if (!(away.dot(away) <= kFarthest * kFarthest)) return strongest;
  }
  return meeting;
}

}  // namespace roadbook
