#include "mapping/occupancy/patch_grid.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "base/error.hpp"
#include "base/target_clones.hpp"
#include "mapping/occupancy/cell_rules.hpp"

namespace roadbook {
namespace {

constexpr double kOne = 65536.0;  // of fixed-point numbers

std::int32_t fixed_point(double value) { return static_cast<std::int32_t>(kOne * value); }

// Steps k of [0, count) for which value + k * slope lies in [0, cells).
int steps_within(double value, double slope, int cells, int count) {
  constexpr double kEdge = 1e-3;  // rounding of the fixed-point numbers
  if (value < 0.0 || value >= cells) return 0;
  if (slope > 0.0) count = std::min(count, static_cast<int>((cells - kEdge - value) / slope) + 1);
  if (slope < 0.0) count = std::min(count, static_cast<int>((value - kEdge) / -slope) + 1);
  return std::max(count, 0);
}

using PairOfFloats = float __attribute__((vector_size(8)));

// The hot loop: bench/occupancy_bench.cpp compares it with a plain Bresenham line. Both numbers
// of a cell are loaded, added and stored together.
ROADBOOK_CLONES
void add_row(OccupancyCell* cells, const BeamSteps& steps, const float* row) {
  OccupancyCell* at = cells + steps.first;
  const std::int32_t minor_step = steps.minor_step;
  const std::int32_t minor_slope = steps.minor_slope;
  const std::int32_t entry_slope = steps.entry_slope;
  const std::int32_t major_step = steps.major_step;
  std::int32_t minor = steps.minor;
  std::int32_t entry = steps.entry;
#pragma GCC unroll 4
  for (int k = steps.count; k > 0; --k) {
    OccupancyCell* const cell = at + (minor >> 16) * minor_step;
    PairOfFloats both;
    std::memcpy(&both, static_cast<const void*>(cell), sizeof both);
    both += PairOfFloats{row[entry >> 16], 1.0F};
    std::memcpy(static_cast<void*>(cell), &both, sizeof both);
    at += major_step;
    minor += minor_slope;
    entry += entry_slope;
  }
}

}  // namespace

CellShape CellShape::over(const Eigen::Vector2d& least,
                          const Eigen::Vector2d& most,
                          double cell_m) {
  const Eigen::Vector2d first = ((least / cell_m).array() + 1e-9).floor();
  const Eigen::Vector2d last = ((most / cell_m).array() - 1e-9).ceil();
  const Eigen::Vector2d count = (last - first).cwiseMax(1.0);
  // Fixed-point numbers hold 15 bits before the point.
  constexpr double kMostCells = 16384.0;
  if (!(count.maxCoeff() < kMostCells))
    throw InvalidOption(
        "cell_m", std::to_string(cell_m),
        "at most 16384 cells along a side of " + std::to_string((most - least).maxCoeff()) + " m");
  return {first * cell_m, cell_m, static_cast<int>(count.x()), static_cast<int>(count.y())};
}

PatchGrid::PatchGrid(const CellShape& shape)
    : CellShape(shape),
      cells(shape.size()),
      hits(shape.size()),
      ends(shape.size(), Eigen::Vector2f::Zero()) {}

BeamSteps::BeamSteps(const CellShape& grid,
                     const Eigen::Vector2d& origin,
                     const Eigen::Vector2d& along,
                     double entry_m,
                     std::size_t entries) {
  // A beam has some 80 cells: its divisions take as long as they do.
  const double per_cell = 1.0 / grid.cell_m;
  const Eigen::Vector2d o = (origin - grid.low) * per_cell;
  const int a = std::abs(along.x()) >= std::abs(along.y()) ? 0 : 1;
  const int b = 1 - a;
  const std::array<int, 2> sizes{grid.columns, grid.rows};
  const std::array<std::int32_t, 2> strides{1, grid.columns};
  const auto size = [&](int axis) { return sizes[static_cast<std::size_t>(axis)]; };
  const auto stride = [&](int axis) { return strides[static_cast<std::size_t>(axis)]; };
  const int sign = along[a] > 0.0 ? 1 : -1;
  const double towards = std::abs(along[a]);
  const double per_step = 1.0 / towards;  // distance between middles [cells]
  const double begin = std::floor(o[a]);
  double distance = (begin + 0.5 - o[a]) * sign * per_step;
  int column = static_cast<int>(begin);
  constexpr double kSame = 1e-9;  // an origin in the middle of its cell, but for rounding
  if (distance < -kSame) {
    column += sign;
    distance += per_step;
  }
  chord_m = per_step * grid.cell_m;
  const double across = o[b] + distance * along[b];
  const double slope = per_step * along[b];
  const double to_entry = grid.cell_m / entry_m;
  const double last = (static_cast<double>(entries) - 0.51) * entry_m * per_cell;  // [cells]
  if (entries == 0 || distance > last || column < 0 || column >= size(a)) return;
  count = static_cast<int>((last - distance) * towards) + 1;
  count = std::min(count, sign > 0 ? size(a) - column : column + 1);
  count = steps_within(across, slope, size(b), count);
  first = column * stride(a);
  major_step = sign * stride(a);
  minor_step = stride(b);
  minor = fixed_point(across);
  minor_slope = fixed_point(slope);
  entry = fixed_point(distance * to_entry + 0.5);
  entry_slope = fixed_point(per_step * to_entry);
}

std::span<const float> row_until(const InverseRangeModel& inverse,
                                 double read_m,
                                 double limit_m,
                                 double chord_m) {
  const auto row = inverse.changes(read_m, chord_m);
  if (limit_m >= read_m) return row;
  return row.first(
      std::min(row.size(), static_cast<std::size_t>(std::max(0.0, limit_m) / inverse.step_m())));
}

std::size_t add_beam(PatchGrid& grid,
                     const Eigen::Vector2d& origin,
                     const Eigen::Vector2d& along,
                     double read_m,
                     double limit_m,
                     const InverseRangeModel& inverse) {
  const double chord = grid.cell_m / std::max(std::abs(along.x()), std::abs(along.y()));
  const auto row = row_until(inverse, read_m, limit_m, chord);
  const BeamSteps steps(grid, origin, along, inverse.step_m(), row.size());
  add_row(grid.cells.data(), steps, row.data());
  if (limit_m >= read_m) count_hit(grid, origin, along, read_m, inverse.max_m());
  return static_cast<std::size_t>(steps.count);
}

std::size_t add_naive(PatchGrid& grid,
                      const Eigen::Vector2d& origin,
                      const Eigen::Vector2d& along,
                      double read_m,
                      double max_m,
                      float certain) {
  const bool open = is_maximum(read_m, max_m);
  const auto entries = static_cast<std::size_t>(std::ceil(read_m / grid.cell_m));
  const BeamSteps steps(grid, origin, along, grid.cell_m, entries);
  const auto set = [&](std::size_t index, double reading) {
    OccupancyCell& cell = grid.cells[index];
    const double state = cell.change < 0.0F ? 0.0 : cell.change > 0.0F ? 1.0 : 0.5;
    const double next = cell.seen == 0.0F ? reading : naive_update(state, reading);
    cell.change = static_cast<float>(2.0 * next - 1.0) * certain;
    cell.seen += 1.0F;
  };
  const Eigen::Vector2d end = (origin + read_m * along - grid.low) / grid.cell_m;
  const int column = static_cast<int>(std::floor(end.x()));
  const int row = static_cast<int>(std::floor(end.y()));
  const std::size_t hit =
      !open && grid.holds(column, row) ? grid.index(column, row) : grid.cells.size();
  for (int k = 0; k < steps.count; ++k)
    if (steps.cell(k) != hit) set(steps.cell(k), 0.0);
  if (hit < grid.cells.size()) set(hit, 1.0);
  count_hit(grid, origin, along, read_m, max_m);
  return static_cast<std::size_t>(steps.count) + 1;
}

void count_hit(PatchGrid& grid,
               const Eigen::Vector2d& origin,
               const Eigen::Vector2d& along,
               double read_m,
               double max_m) {
  if (is_maximum(read_m, max_m)) return;
  const Eigen::Vector2d end = (origin + read_m * along - grid.low) * (1.0 / grid.cell_m);
  const int column = static_cast<int>(std::floor(end.x()));
  const int row = static_cast<int>(std::floor(end.y()));
  if (!grid.holds(column, row)) return;
  const std::size_t cell = grid.index(column, row);
  ++grid.hits[cell];
  grid.ends[cell] += (end - Eigen::Vector2d(column + 0.5, row + 0.5)).cast<float>();
}

}  // namespace roadbook
