#include "sim/world/moved_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <set>
#include <utility>

#include "base/random.hpp"
#include "sim/world/noise.hpp"
#include "sim/world/path.hpp"

namespace roadbook {
namespace {

constexpr double kSide = 4.0;    // [m]
constexpr double kBeside = 5.0;  // [m] from the route to their middle: what the cameras see well
constexpr double kLeastShift = 0.25;
constexpr double kMostShift = 0.6;
constexpr double kFarStones = 3.0;  // [m]: other stones, not the same ones moved

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

// Selects `share` of the squares near the route, each with a random shift.
std::vector<MovedPatch> some_patches(
    const Scenario& scenario, double share, double least_shift, double most_shift, Random random) {
  if (share <= 0.0) return {};
  auto cells = cells_beside(route_line(scenario, scenario.route));
  const auto wanted = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::lround(share * static_cast<double>(cells.size()))), 1,
      cells.size());
  std::vector<MovedPatch> patches;
  for (std::size_t i = 0; i < wanted; ++i) {
    std::swap(cells[i], cells[i + random.below(cells.size() - i)]);
    const Eigen::Vector2d low = kSide * Eigen::Vector2d(cells[i].first, cells[i].second);
    const double length = random.uniform(least_shift, most_shift);
    const double course = random.uniform(0.0, 2.0 * std::numbers::pi);
    patches.push_back({low, low + Eigen::Vector2d::Constant(kSide),
                       length * Eigen::Vector2d(std::cos(course), std::sin(course))});
  }
  return patches;
}

// The square in texels, cut to the raster.
cv::Rect texels_of(const MovedPatch& patch, const Canvas& canvas) {
  const Eigen::Vector2i low =
      ((patch.low - canvas.low) / canvas.texel_m).array().round().cast<int>();
  const Eigen::Vector2i size =
      ((patch.high - patch.low) / canvas.texel_m).array().round().cast<int>();
  return cv::Rect(low.x(), low.y(), size.x(), size.y()) &
         cv::Rect(0, 0, canvas.image.cols, canvas.image.rows);
}

}  // namespace

std::vector<MovedPatch> moved_patches(const Scenario& scenario, double share, std::uint64_t seed) {
  return some_patches(scenario, share, kLeastShift, kMostShift, Random(seed, "moved patches"));
}

std::vector<MovedPatch> removed_patches(const Scenario& scenario,
                                        double share,
                                        std::uint64_t seed) {
  auto patches =
      some_patches(scenario, share, kFarStones, 2.0 * kFarStones, Random(seed, "gone patches"));
  for (MovedPatch& patch : patches) patch.gone = true;
  return patches;
}

std::vector<MovedPatch> changed_patches(const Scenario& scenario,
                                        const EffectSizes& effects,
                                        std::uint64_t seed) {
  auto patches = removed_patches(scenario, effect_size(effects, "map", "landmarks_gone"), seed);
  const std::size_t gone = patches.size();
  for (const MovedPatch& moved :
       moved_patches(scenario, effect_size(effects, "map", "moved_landmarks"), seed))
    if (std::none_of(patches.begin(), patches.begin() + static_cast<std::ptrdiff_t>(gone),
                     [&](const MovedPatch& p) { return p.low == moved.low; }))
      patches.push_back(moved);
  return patches;
}

void move_content(const std::vector<MovedPatch>& patches, Canvas& canvas) {
  if (patches.empty()) return;
  const cv::Mat before = canvas.image.clone();
  const cv::Rect whole(0, 0, before.cols, before.rows);
  for (const MovedPatch& patch : patches) {
    if (patch.gone) continue;
    const Eigen::Vector2i shift = (patch.shift / canvas.texel_m).array().round().cast<int>();
    const cv::Point step(shift.x(), shift.y());
    // A rectangle plus a point is moved by it.
    const cv::Rect to = texels_of(patch, canvas) & (whole + step);
    if (to.empty()) continue;
    before(to - step).copyTo(canvas.image(to));
  }
}

void pave(const std::vector<MovedPatch>& patches, const GroundSpec& ground, Canvas& brightness) {
  constexpr std::uint32_t kNewAsphalt = 4099;  // other grains than the old one's
  const double base = 255.0 * ground.brightness;
  for (const MovedPatch& patch : patches) {
    if (!patch.gone) continue;
    const cv::Rect to = texels_of(patch, brightness);
    for (int y = to.y; y < to.y + to.height; ++y)
      for (int x = to.x; x < to.x + to.width; ++x) {
        const Eigen::Vector2f p =
            (brightness.low + brightness.texel_m * Eigen::Vector2d(x + 0.5, y + 0.5)).cast<float>();
        const double broad = fractal_noise(0.25F * p.x(), 0.25F * p.y(), 3, kNewAsphalt);
        const double fine = fractal_noise(4.0F * p.x(), 4.0F * p.y(), 3, kNewAsphalt + 1);
        brightness.image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(
            base * (1.0 + 0.15 * broad) + ground.roughness * 16.0 * fine);
      }
  }
}

void clear_kinds(const std::vector<MovedPatch>& patches, std::uint8_t road, Canvas& kind) {
  for (const MovedPatch& patch : patches)
    if (patch.gone) kind.image(texels_of(patch, kind)).setTo(road);
}

}  // namespace roadbook
