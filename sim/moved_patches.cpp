#include "sim/moved_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <set>
#include <utility>

#include "base/random.hpp"
#include "sim/path.hpp"

namespace roadbook {
namespace {

constexpr double kSide = 4.0;    // [m]
constexpr double kBeside = 5.0;  // [m] from the route to their middle: what the cameras see well
constexpr double kLeastShift = 0.25;
constexpr double kMostShift = 0.6;

int cell(double x) { return static_cast<int>(std::floor(x / kSide)); }

// Cells with a middle near the route, ascending.
std::vector<std::pair<int, int>> cells_beside(const DrivingLine& line) {
  std::set<std::pair<int, int>> cells;
  for (const Eigen::Vector2d& p : line.sampled(0.5))
    for (int i = cell(p.x() - kBeside); i <= cell(p.x() + kBeside); ++i)
      for (int j = cell(p.y() - kBeside); j <= cell(p.y() + kBeside); ++j)
        if ((kSide * Eigen::Vector2d(i + 0.5, j + 0.5) - p).norm() < kBeside) cells.insert({i, j});
  return {cells.begin(), cells.end()};
}

}  // namespace

std::vector<MovedPatch> moved_patches(const Scenario& scenario, double share, std::uint64_t seed) {
  if (share <= 0.0) return {};
  auto cells = cells_beside(route_line(scenario, scenario.route));
  const auto wanted = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::lround(share * static_cast<double>(cells.size()))), 1,
      cells.size());
  Random random(seed, "moved patches");
  std::vector<MovedPatch> patches;
  for (std::size_t i = 0; i < wanted; ++i) {
    std::swap(cells[i], cells[i + random.below(cells.size() - i)]);
    const Eigen::Vector2d low = kSide * Eigen::Vector2d(cells[i].first, cells[i].second);
    const double length = random.uniform(kLeastShift, kMostShift);
    const double course = random.uniform(0.0, 2.0 * std::numbers::pi);
    patches.push_back({low, low + Eigen::Vector2d::Constant(kSide),
                       length * Eigen::Vector2d(std::cos(course), std::sin(course))});
  }
  return patches;
}

void move_content(const std::vector<MovedPatch>& patches, Canvas& canvas) {
  if (patches.empty()) return;
  const cv::Mat before = canvas.image.clone();
  const cv::Rect whole(0, 0, before.cols, before.rows);
  for (const MovedPatch& patch : patches) {
    const Eigen::Vector2i low =
        ((patch.low - canvas.low) / canvas.texel_m).array().round().cast<int>();
    const Eigen::Vector2i size =
        ((patch.high - patch.low) / canvas.texel_m).array().round().cast<int>();
    const Eigen::Vector2i shift = (patch.shift / canvas.texel_m).array().round().cast<int>();
    const cv::Point step(shift.x(), shift.y());
    const cv::Rect to = cv::Rect(low.x(), low.y(), size.x(), size.y()) & whole &
                        (whole + step);  // a rectangle plus a point is moved by it
    if (to.empty()) continue;
    before(to - step).copyTo(canvas.image(to));
  }
}

}  // namespace roadbook
