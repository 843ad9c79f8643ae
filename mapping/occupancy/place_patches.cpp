#include "mapping/occupancy/place_patches.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "base/error.hpp"
#include "mapping/occupancy/cell_rules.hpp"
#include "mapping/occupancy/reading_dependence.hpp"
#include "sensors/range/inverse_range.hpp"

namespace roadbook {
namespace {

constexpr double kMove = 0.25;           // [cells]
constexpr std::uint32_t kFewAtEdge = 3;  // readings

std::array<Eigen::Vector2d, 4> corners_of(const OccupancyPatch& patch, const PlanePose& at) {
  const Eigen::Isometry2d T = at.isometry();
  const double x = patch.columns * patch.cell_m, y = patch.rows * patch.cell_m;
  return {T * Eigen::Vector2d(0, 0), T * Eigen::Vector2d(x, 0), T * Eigen::Vector2d(0, y),
          T * Eigen::Vector2d(x, y)};
}

bool has_moved(const OccupancyPatch& patch, const PlanePose& now) {
  const auto was = corners_of(patch, patch.placed);
  const auto is = corners_of(patch, now);
  for (std::size_t i = 0; i < was.size(); ++i)
    if ((was[i] - is[i]).norm() > kMove * patch.cell_m) return true;
  return false;
}

// The readings of one drive, before they are tempered.
struct DriveSum {
  std::vector<float> change;
  std::vector<std::uint32_t> seen;

  explicit DriveSum(std::size_t cells) : change(cells, 0.0F), seen(cells, 0) {}

  /// A cell of the map and the patch's cell at its middle. Evidence of a surface comes by
  /// `add_surface` where the patch is turned: a wall would be drawn twice at some places.
  void add(const OccupancyPatch& patch,
           std::size_t from,
           std::size_t to,
           bool with_surfaces,
           std::int32_t number,
           OccupancyGrid& grid) {
    if (patch.seen[from] == 0) return;
    if (with_surfaces || patch.log_odds[from] < 0) change[to] += changed(patch, from);
    seen[to] += patch.seen[from];
    if (with_surfaces) grid.hits[to] += patch.hits[from];
    grid.newest[to] = std::max(grid.newest[to], number);
  }
  /// A cell of the patch and the map's cell where its readings ended.
  void add_surface(const OccupancyPatch& patch,
                   std::size_t from,
                   std::size_t to,
                   std::int32_t number,
                   OccupancyGrid& grid) {
    if (patch.log_odds[from] >= 0) change[to] += changed(patch, from);
    grid.hits[to] += patch.hits[from];
    if (patch.hits[from] == 0) return;
    seen[to] = std::max<std::uint32_t>(seen[to], patch.seen[from]);
    grid.newest[to] = std::max(grid.newest[to], number);
  }
  static float changed(const OccupancyPatch& patch, std::size_t from) {
    return static_cast<float>(kLogOddsUnit) * static_cast<float>(patch.log_odds[from]);
  }
  void add_to(double temper, OccupancyGrid& grid) const {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] == 0) continue;
      const double readings = seen[i];
      const double weight = tempered_weight(readings, temper);
      grid.change[i] += static_cast<float>(weight) * change[i];
      grid.effective[i] += static_cast<float>(weight * readings);
      grid.seen[i] += seen[i];
      grid.drives[i] = static_cast<std::uint8_t>(std::min(grid.drives[i] + 1, 255));
    }
  }
};

// Draws a patch: for every cell of the map under it, the patch's cell at the middle. Fixed-point
// numbers have 32 fractional bits.
template <typename Add>
void draw(const OccupancyPatch& patch, const OccupancyGrid& grid, const Add& add) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector2d& corner : corners_of(patch, patch.placed)) {
    const Eigen::Vector2d p = (corner - grid.shape.low) / grid.shape.cell_m;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Isometry2d T = patch.placed.isometry().inverse();
  constexpr double kWhole = 4294967296.0;
  const auto fixed_point = [](double v) {
    return static_cast<std::int64_t>(std::llround(kWhole * v));
  };
  const std::int64_t step_x = fixed_point(T(0, 0)), step_y = fixed_point(T(1, 0));
  const int first_row = std::max(0, static_cast<int>(std::floor(low.y())));
  const int last_row = std::min(grid.shape.rows, static_cast<int>(std::ceil(high.y())));
  const int first = std::max(0, static_cast<int>(std::floor(low.x())));
  const int last = std::min(grid.shape.columns, static_cast<int>(std::ceil(high.x())));
  for (int r = first_row; r < last_row; ++r) {
    const Eigen::Vector2d p =
        T * (grid.shape.low + grid.shape.cell_m * Eigen::Vector2d(first + 0.5, r + 0.5)) /
        patch.cell_m;
    std::int64_t x = fixed_point(p.x()), y = fixed_point(p.y());
    for (int c = first; c < last; ++c, x += step_x, y += step_y) {
      const std::int64_t column = x >> 32, row = y >> 32;
      if (column < 0 || row < 0 || column >= patch.columns || row >= patch.rows) continue;
      add(static_cast<std::size_t>(row) * static_cast<std::size_t>(patch.columns) +
              static_cast<std::size_t>(column),
          grid.shape.index(c, r));
    }
  }
}

// Whether the cells of the patch are cells of the map.
bool is_aligned(const OccupancyPatch& patch, const CellShape& shape) {
  constexpr double kSame = 1e-6;  // [cells]
  const Eigen::Vector2d p =
      (Eigen::Vector2d(patch.placed.x_m, patch.placed.y_m) - shape.low) / shape.cell_m;
  return std::abs(patch.placed.heading_rad) * std::max(patch.columns, patch.rows) < kSame &&
         std::abs(p.x() - std::round(p.x())) < kSame && std::abs(p.y() - std::round(p.y())) < kSame;
}

// Where the evidence of a surface in a cell lies [cells, patch]: where its readings ended. The
// noise of readings spreads evidence to the cells beside; there it is as far from their middle as
// that of the readings next to them is.
Eigen::Vector2d place_of_evidence(const OccupancyPatch& patch,
                                  int column,
                                  int row,
                                  std::size_t cell) {
  if (patch.hits[cell] > 0) return patch.end_in(column, row, cell);
  const Eigen::Vector2d middle(column + 0.5, row + 0.5);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (int r = std::max(0, row - 1); r <= std::min(row + 1, patch.rows - 1); ++r)
    for (int c = std::max(0, column - 1); c <= std::min(column + 1, patch.columns - 1); ++c) {
      const auto near = static_cast<std::size_t>(r) * static_cast<std::size_t>(patch.columns) +
                        static_cast<std::size_t>(c);
      if (patch.hits[near] == 0) continue;
      sum += patch.hits[near] * (patch.end_in(c, r, near) - Eigen::Vector2d(c + 0.5, r + 0.5));
      count += patch.hits[near];
    }
  return count > 0.0 ? Eigen::Vector2d(middle + sum / count) : middle;
}

// For every cell of the patch with evidence of a surface: the map's cell where its readings ended.
template <typename Add>
void draw_surfaces(const OccupancyPatch& patch, const OccupancyGrid& grid, const Add& add) {
  const Eigen::Isometry2d T = patch.placed.isometry();
  for (int r = 0; r < patch.rows; ++r)
    for (int c = 0; c < patch.columns; ++c) {
      const std::size_t from =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(patch.columns) +
          static_cast<std::size_t>(c);
      if (patch.seen[from] == 0 || (patch.log_odds[from] < 0 && patch.hits[from] == 0)) continue;
      const Eigen::Vector2d end = T * (patch.cell_m * place_of_evidence(patch, c, r, from));
      const Eigen::Vector2d p = (end - grid.shape.low) / grid.shape.cell_m;
      const int column = static_cast<int>(std::floor(p.x()));
      const int row = static_cast<int>(std::floor(p.y()));
      if (grid.shape.holds(column, row)) add(from, grid.shape.index(column, row));
    }
}

// At the edge of what was seen, rays may have passed beside the surface that ends the view: a cell
// is a square, the surface in it a curve, and no ray through the next cell would have met it. A
// cell there that few readings passed stays unknown: of such cells, 2 to 5 % are occupied, of those
// with more readings 0.3 to 2 % (docs/results/occupancy.md). `kept`: cells where few readings
// count.
void forget_few_at_edge(const std::vector<char>& kept, OccupancyGrid& grid) {
  const CellShape& shape = grid.shape;
  const auto unknown = [&](int column, int row) {
    return !shape.holds(column, row) || grid.seen[shape.index(column, row)] == 0;
  };
  std::vector<std::size_t> few;
  for (int r = 0; r < shape.rows; ++r)
    for (int c = 0; c < shape.columns; ++c) {
      const std::size_t i = shape.index(c, r);
      if (grid.seen[i] > 0 && grid.seen[i] <= kFewAtEdge && grid.change[i] < 0.0F && kept[i] == 0 &&
          (unknown(c - 1, r) || unknown(c + 1, r) || unknown(c, r - 1) || unknown(c, r + 1)))
        few.push_back(i);
    }
  for (const std::size_t i : few) {
    grid.change[i] = 0.0F;
    grid.seen[i] = grid.hits[i] = 0;
    grid.effective[i] = 0.0F;
    grid.drives[i] = 0;
    grid.newest[i] = -1;
  }
}

CellShape shape_over(const std::vector<OccupancyPatch>& patches,
                     const std::vector<std::size_t>& used) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const std::size_t i : used)
    for (const Eigen::Vector2d& corner : corners_of(patches[i], patches[i].placed)) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  return CellShape::over(low, high, patches[used.front()].cell_m);
}

}  // namespace

double OccupancyGrid::probability(std::size_t cell, double prior_log_odds) const {
  return probability_of(prior_log_odds + static_cast<double>(change[cell]));
}

double OccupancyGrid::sigma(std::size_t cell, double prior_log_odds) const {
  static const double half_passed = -0.5 * std::log1p(-kMetInCell);
  const double p = probability(cell, prior_log_odds);
  const double n = std::min(static_cast<double>(effective[cell]),
                            std::abs(static_cast<double>(change[cell])) / half_passed);
  return std::sqrt(p * (1.0 - p) / (1.0 + n));
}

OccupancyGrid place_patches(std::vector<OccupancyPatch>& patches,
                            const PoseOfKeyframe& pose_of,
                            const std::map<std::string, ReadingWeight>& drives) {
  OccupancyGrid grid;
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto pose = pose_of(patches[i].session, patches[i].t_ns);
    if (!pose) {
      ++grid.without_pose;
      continue;
    }
    used.push_back(i);
    const PlanePose now =
        plane_pose(Eigen::Isometry2d(pose->isometry() * patches[i].vehicle_patch.isometry()));
    if (!has_moved(patches[i], now)) continue;
    patches[i].placed = now;
    ++grid.moved;
  }
  if (used.empty()) return grid;
  std::stable_sort(used.begin(), used.end(), [&](std::size_t a, std::size_t b) {
    return patches[a].end_ns < patches[b].end_ns;
  });
  grid.shape = shape_over(patches, used);
  const std::size_t cells = grid.shape.size();
  grid.change.assign(cells, 0.0F);
  grid.seen.assign(cells, 0);
  grid.hits.assign(cells, 0);
  grid.effective.assign(cells, 0.0F);
  grid.drives.assign(cells, 0);
  grid.newest.assign(cells, -1);
  std::vector<std::string> names;
  for (const std::size_t i : used)
    if (std::find(names.begin(), names.end(), patches[i].drive) == names.end())
      names.push_back(patches[i].drive);
  std::vector<char> kept(cells, 0);
  for (const std::string& drive : names) {
    DriveSum sum(cells);
    for (std::size_t n = 0; n < used.size(); ++n) {
      const OccupancyPatch& patch = patches[used[n]];
      if (patch.drive != drive) continue;
      ROADBOOK_ASSERT(patch.cell_m == grid.shape.cell_m);
      const auto number = static_cast<std::int32_t>(n);
      const bool aligned = is_aligned(patch, grid.shape);
      draw(patch, grid, [&](std::size_t from, std::size_t to) {
        sum.add(patch, from, to, aligned, number, grid);
      });
      if (!aligned)
        draw_surfaces(patch, grid, [&](std::size_t from, std::size_t to) {
          sum.add_surface(patch, from, to, number, grid);
        });
    }
    const auto found = drives.find(drive);
    const ReadingWeight readings = found == drives.end() ? ReadingWeight{} : found->second;
    sum.add_to(readings.temper, grid);
    if (readings.few_count)
      for (std::size_t i = 0; i < cells; ++i)
        if (sum.seen[i] > 0) kept[i] = 1;
  }
  forget_few_at_edge(kept, grid);
  // Numbers in the order of time become those of the patches.
  for (std::int32_t& newest : grid.newest)
    if (newest >= 0) newest = static_cast<std::int32_t>(used[static_cast<std::size_t>(newest)]);
  return grid;
}

}  // namespace roadbook
