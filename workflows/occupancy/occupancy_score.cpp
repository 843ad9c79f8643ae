#include "workflows/occupancy/occupancy_score.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "exchange/layers/packed_numbers.hpp"

namespace roadbook {
namespace {

enum class CellKind : std::uint8_t { kUnknown, kFree, kUndecided, kOccupied };

std::vector<CellKind> kinds_of(const OccupancyGrid& grid, double prior) {
  std::vector<CellKind> kinds(grid.shape.size(), CellKind::kUnknown);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    if (grid.seen[i] == 0) continue;
    const double p = grid.probability(i, prior);
    kinds[i] = is_free(p, grid.sigma(i, prior)) ? CellKind::kFree
               : p > kOccupiedProbability       ? CellKind::kOccupied
                                                : CellKind::kUndecided;
  }
  return kinds;
}

// Regions of a quadtree in which all cells are of one kind; unknown ones do not count.
std::size_t regions(
    const std::vector<CellKind>& kinds, const CellShape& shape, int column, int row, int side) {
  if (column >= shape.columns || row >= shape.rows) return 0;
  const CellKind first = kinds[shape.index(column, row)];
  bool same = true;
  for (int r = row; r < std::min(row + side, shape.rows) && same; ++r)
    for (int c = column; c < std::min(column + side, shape.columns) && same; ++c)
      same = kinds[shape.index(c, r)] == first;
  if (same) return first == CellKind::kUnknown ? 0 : 1;
  const int half = side / 2;
  return regions(kinds, shape, column, row, half) +
         regions(kinds, shape, column + half, row, half) +
         regions(kinds, shape, column, row + half, half) +
         regions(kinds, shape, column + half, row + half, half);
}

template <typename Is>
bool any_near(const CellShape& shape, int column, int row, const Is& is) {
  for (int r = row - 1; r <= row + 1; ++r)
    for (int c = column - 1; c <= column + 1; ++c)
      if (shape.holds(c, r) && is(shape.index(c, r))) return true;
  return false;
}

}  // namespace

OccupancyFigures occupancy_figures(const StoredOccupancy& stored, const OccupancyGrid& grid) {
  OccupancyFigures figures;
  const auto kinds = kinds_of(grid, stored.prior_log_odds());
  std::size_t vanished = 0;
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    figures.cells += kinds[i] != CellKind::kUnknown ? 1U : 0U;
    figures.free += kinds[i] == CellKind::kFree ? 1U : 0U;
    figures.occupied += kinds[i] == CellKind::kOccupied ? 1U : 0U;
    figures.undecided += kinds[i] == CellKind::kUndecided ? 1U : 0U;
    vanished += kinds[i] == CellKind::kFree && grid.hits[i] >= 2 ? 1U : 0U;
  }
  if (figures.cells == 0) return figures;
  std::size_t bytes = 0;
  for (const OccupancyPatch& p : stored.patches)
    bytes += packed_numbers(p.log_odds).size() + packed_numbers(p.seen).size() +
             packed_numbers(p.hits).size() + packed_numbers(p.ends).size();
  const auto cells = static_cast<double>(figures.cells);
  figures.bytes_per_m2 =
      static_cast<double>(bytes) / (cells * grid.shape.cell_m * grid.shape.cell_m);
  int side = 1;
  while (side < std::max(grid.shape.columns, grid.shape.rows)) side *= 2;
  figures.merged_share = static_cast<double>(regions(kinds, grid.shape, 0, 0, side)) / cells;
  figures.vanished_share =
      static_cast<double>(vanished) / std::max(1.0, static_cast<double>(figures.free));
  return figures;
}

TrueCells true_cells(const CellShape& shape,
                     const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& surfaces) {
  constexpr double kStep = 0.02;  // [cells]
  TrueCells truth;
  truth.occupied.assign(shape.size(), 0);
  for (const auto& [from, to] : surfaces) {
    const Eigen::Vector2d a = (from - shape.low) / shape.cell_m;
    const Eigen::Vector2d b = (to - shape.low) / shape.cell_m;
    const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / kStep)));
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector2d p = a + (b - a) * (static_cast<double>(i) / steps);
      const int column = static_cast<int>(std::floor(p.x()));
      const int row = static_cast<int>(std::floor(p.y()));
      if (shape.holds(column, row)) truth.occupied[shape.index(column, row)] = 1;
    }
  }
  return truth;
}

OccupancyTruth score_occupancy(const OccupancyGrid& grid,
                               double prior_log_odds,
                               const TrueCells& truth) {
  constexpr std::size_t kIntervals = 10;
  OccupancyTruth score;
  score.mean_probability.assign(kIntervals, 0.0);
  score.true_share.assign(kIntervals, 0.0);
  score.count.assign(kIntervals, 0);
  const auto kinds = kinds_of(grid, prior_log_odds);
  std::array<double, 2> called{}, all{};
  double found = 0.0, cells = 0.0;
  for (int r = 0; r < grid.shape.rows; ++r)
    for (int c = 0; c < grid.shape.columns; ++c) {
      const std::size_t i = grid.shape.index(c, r);
      if (grid.seen[i] == 0) continue;
      const double p = grid.probability(i, prior_log_odds);
      const auto interval = std::min(kIntervals - 1, static_cast<std::size_t>(p * kIntervals));
      const bool occupied = truth.occupied[i] != 0;
      score.mean_probability[interval] += p;
      score.true_share[interval] += occupied ? 1.0 : 0.0;
      ++score.count[interval];
      cells += 1.0;
      all[occupied ? 1 : 0] += 1.0;
      if (!occupied) {
        called[0] += kinds[i] == CellKind::kFree ? 1.0 : 0.0;
        continue;
      }
      found +=
          any_near(grid.shape, c, r, [&](std::size_t k) { return kinds[k] == CellKind::kOccupied; })
              ? 1.0
              : 0.0;
      called[1] +=
          kinds[i] == CellKind::kFree && !any_near(grid.shape, c, r,
                                                   [&](std::size_t k) {
                                                     return kinds[k] == CellKind::kOccupied ||
                                                            kinds[k] == CellKind::kUndecided;
                                                   })
              ? 1.0
              : 0.0;
    }
  for (std::size_t k = 0; k < kIntervals; ++k) {
    if (score.count[k] == 0) continue;
    const auto count = static_cast<double>(score.count[k]);
    score.mean_probability[k] /= count;
    score.true_share[k] /= count;
    score.calibration_error +=
        count / cells * std::abs(score.mean_probability[k] - score.true_share[k]);
  }
  score.free_recall = called[0] / std::max(1.0, all[0]);
  score.occupied_called_free = called[1] / std::max(1.0, all[1]);
  score.occupied_recall = found / std::max(1.0, all[1]);
  return score;
}

OccupancyTrails score_trails(const OccupancyGrid& grid,
                             double prior_log_odds,
                             const TrueCells& truth,
                             const std::vector<Eigen::Vector2d>& walked) {
  constexpr double kBody_m = 0.3;
  const CellShape& shape = grid.shape;
  std::vector<char> crossed(shape.size(), 0);
  const int reach = static_cast<int>(kBody_m / shape.cell_m);
  for (const Eigen::Vector2d& p : walked) {
    const Eigen::Vector2d at = (p - shape.low) / shape.cell_m;
    for (int dr = -reach; dr <= reach; ++dr)
      for (int dc = -reach; dc <= reach; ++dc) {
        const int column = static_cast<int>(std::floor(at.x())) + dc;
        const int row = static_cast<int>(std::floor(at.y())) + dr;
        if (dr * dr + dc * dc <= reach * reach && shape.holds(column, row))
          crossed[shape.index(column, row)] = 1;
      }
  }
  OccupancyTrails trails;
  double called = 0.0;
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    if (crossed[i] == 0 || truth.occupied[i] != 0 || grid.seen[i] == 0) continue;
    ++trails.crossed;
    called += grid.probability(i, prior_log_odds) > kOccupiedProbability ? 1.0 : 0.0;
  }
  if (trails.crossed > 0) trails.called_occupied = called / static_cast<double>(trails.crossed);
  return trails;
}

}  // namespace roadbook
