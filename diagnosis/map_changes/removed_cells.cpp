#include "diagnosis/map_changes/removed_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/cell_grid.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kOffsets = 4;  // shifted by half a side along x, y or both
constexpr std::size_t kSteps = 60;   // most cells removed
constexpr std::size_t kVain = 3;     // consecutive failures that end the search

// Cells of one side length and offset, with their landmarks.
using Cells = std::map<GridCell<2>, std::vector<std::size_t>>;

// Shift of a grid in side lengths.
Eigen::Vector2d shift_of(std::size_t offset) {
  return {offset % 2 == 0 ? 0.0 : 0.5, offset < 2 ? 0.0 : 0.5};
}

Cells landmark_cells(const std::vector<LandmarkRedetection>& chances,
                     double side_m,
                     std::size_t offset) {
  const Eigen::Vector2d shift = shift_of(offset);
  Cells cells;
  for (std::size_t i = 0; i < chances.size(); ++i)
    cells[cell_at<2>(chances[i].p_map.head<2>() / side_m + shift, 1.0)].push_back(i);
  return cells;
}

void add_squares(const std::vector<LandmarkRedetection>& chances,
                 const std::vector<std::uint8_t>& stands,
                 const RemovedCellOptions& options,
                 PresentCells& all) {
  const std::size_t size = all.scatter.size();
  const double side_m = options.sides_m[size];
  std::vector<GroupCount> groups;  // of one offset only, so that each landmark counts once
  for (std::size_t offset = 0; offset < kOffsets; ++offset)
    for (auto& [cell, landmarks] : landmark_cells(chances, side_m, offset)) {
      std::erase_if(landmarks, [&](std::size_t i) { return stands[i] == 0; });
      GroupCount group = count_of(landmarks, chances);
      if (group.expected() < options.least_expected) continue;
      if (offset == 0) groups.push_back(std::move(group));
      const Eigen::Vector2d corner =
          side_m * (Eigen::Vector2d(static_cast<double>(cell[0]), static_cast<double>(cell[1])) -
                    shift_of(offset));
      all.squares.push_back({std::move(landmarks), size, corner});
    }
  all.scatter.push_back(scatter_of(groups));
  all.can_tell.push_back(groups.empty() ? 0 : 1);
}

RemovedCell surest(const PresentCells& standing, const std::vector<LandmarkRedetection>& chances) {
  RemovedCell best;
  for (const RemovedCell& square : standing.squares)
    if (const double p = chance_of(square.landmarks, standing.scatter[square.size], chances);
        p < best.p) {
      best = square;
      best.p = p;
    }
  return best;
}

// Largest number of cells within `apart_m` of one cell.
std::size_t most_neighbours(const std::vector<RemovedCell>& squares,
                            const RemovedCellOptions& options) {
  std::size_t most = 0;
  for (const RemovedCell& a : squares) {
    std::size_t count = 0;
    for (const RemovedCell& b : squares) {
      const Eigen::Array2d off = b.corner - a.corner;
      if ((off < options.sides_m[a.size] + options.apart_m).all() &&
          (-off < options.sides_m[b.size] + options.apart_m).all())
        ++count;
    }
    most = std::max(most, count - 1);
  }
  return most;
}

}  // namespace

double PresentCells::widest_scatter() const {
  double widest = 0.0;
  for (std::size_t size = 0; size < scatter.size(); ++size)
    if (can_tell[size] != 0) widest = std::max(widest, scatter[size]);
  return widest;
}

PresentCells present_cells(const std::vector<std::uint8_t>& stands,
                           const RemovedCellOptions& options,
                           std::vector<LandmarkRedetection>& chances) {
  fit_redetection_probabilities(stands, chances);
  PresentCells all;
  for (std::size_t size = 0; size < options.sides_m.size(); ++size)
    add_squares(chances, stands, options, all);
  return all;
}

RemovedCells removed_cells(std::vector<LandmarkRedetection>& chances,
                           const RemovedCellOptions& options) {
  std::vector<std::uint8_t> stands(chances.size(), 1);
  PresentCells now = present_cells(stands, options, chances);
  RemovedCells fallen;
  fallen.tests = now.squares;
  fallen.neighbours = most_neighbours(now.squares, options);
  std::size_t sure = 0;
  while (fallen.squares.size() < kSteps && fallen.squares.size() < sure + kVain) {
    RemovedCell next = surest(now, chances);
    if (next.p >= 1.0) break;
    for (const std::size_t i : next.landmarks) stands[i] = 0;
    PresentCells left = present_cells(stands, options, chances);
    if (left.can_tell[next.size] == 0) break;  // no cells are left to estimate the variation
    now = std::move(left);
    next.p = chance_of(next.landmarks, now.scatter[next.size], chances);
    fallen.squares.push_back(std::move(next));
    if (fallen.squares.back().p < options.try_at) sure = fallen.squares.size();
  }
  fallen.squares.resize(sure);
  return fallen;
}

GroupCount count_of(const std::vector<std::size_t>& landmarks,
                    const std::vector<LandmarkRedetection>& chances) {
  GroupCount group;
  group.chances.reserve(landmarks.size());
  for (const std::size_t i : landmarks) {
    group.chances.push_back(chances[i].chance);
    group.count += chances[i].found ? 1 : 0;
  }
  return group;
}

double chance_of(const std::vector<std::size_t>& landmarks,
                 double scatter,
                 const std::vector<LandmarkRedetection>& chances) {
  const GroupCount g = count_of(landmarks, chances);
  return g.count > kMostLeft * g.expected() ? 1.0 : group_tail(g, scatter);
}

}  // namespace roadbook
