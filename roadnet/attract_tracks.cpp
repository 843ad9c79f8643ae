#include "roadnet/attract_tracks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

#include "roadnet/samples.hpp"

namespace roadbook {
namespace {

constexpr int kLineDirections = 12;   // of a line without sense: 15 degrees each
constexpr double kCellsAWidth = 3.0;  // the window is smooth over a cell
constexpr int kReach = 7;             // cells: 2.3 standard deviations

/// Positions driven along about one line, counted together.
struct LineCell {
  std::array<int, 4> place;  ///< x, y, height, direction
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Vector2d twice = Eigen::Vector2d::Zero();  ///< directions at twice their angle: no sense
  double count = 0.0;

  [[nodiscard]] Eigen::Vector2d mean() const { return sum / count; }
  [[nodiscard]] Eigen::Vector2d across() const {
    const double angle = 0.5 * std::atan2(twice.y(), twice.x());
    return {-std::sin(angle), std::cos(angle)};
  }
};

class Cells {
 public:
  explicit Cells(const AttractionOptions& options)
      : size_m_(options.width_m / kCellsAWidth), floor_m_(options.floor_m) {}

  std::size_t add(const Eigen::Vector3d& p, const Eigen::Vector3d& along) {
    const double angle = std::atan2(along.y(), along.x()) + std::numbers::pi;
    const auto whole = [](double v) { return static_cast<int>(std::floor(v)); };
    const std::array<int, 4> place{
        whole(p.x() / size_m_), whole(p.y() / size_m_), whole(p.z() / floor_m_),
        whole(angle / std::numbers::pi * kLineDirections) % kLineDirections};
    std::vector<std::size_t>& column = columns_[key(place[0], place[1])];
    const auto found = std::find_if(column.begin(), column.end(),
                                    [&](std::size_t c) { return cells_[c].place == place; });
    const std::size_t at = found != column.end() ? *found : cells_.size();
    if (found == column.end()) {
      column.push_back(at);
      cells_.push_back({.place = place});
    }
    LineCell& cell = cells_[at];
    cell.sum += p.head<2>();
    cell.twice += Eigen::Vector2d(std::cos(2.0 * angle), std::sin(2.0 * angle));
    cell.count += 1.0;
    return at;
  }

  /// How far every cell's positions move, across the line driven.
  [[nodiscard]] std::vector<Eigen::Vector2d> shifts(double width_m) const {
    std::vector<Eigen::Vector2d> all;
    for (const LineCell& cell : cells_) {
      const Eigen::Vector2d mean = cell.mean();
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      double weight = 0.0;
      visit_near(cell, [&](const LineCell& other) {
        const Eigen::Vector2d d = other.mean() - mean;
        const double w = other.count * std::exp(-0.5 * d.squaredNorm() / (width_m * width_m));
        sum += w * d;
        weight += w;
      });
      const Eigen::Vector2d across = cell.across();
      all.emplace_back(across * across.dot(sum / weight));
    }
    return all;
  }

 private:
  [[nodiscard]] static std::uint64_t key(int x, int y) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x)) << 32U |
           static_cast<std::uint32_t>(y);
  }

  template <typename Visit>
  void visit_near(const LineCell& cell, const Visit& visit) const {
    for (int dx = -kReach; dx <= kReach; ++dx)
      for (int dy = -kReach; dy <= kReach; ++dy) {
        if (dx * dx + dy * dy > kReach * kReach) continue;
        const auto column = columns_.find(key(cell.place[0] + dx, cell.place[1] + dy));
        if (column == columns_.end()) continue;
        for (const std::size_t c : column->second) {
          const auto& other = cells_[c].place;
          const int turn = std::abs(other[3] - cell.place[3]);
          if (std::min(turn, kLineDirections - turn) <= 2 &&
              std::abs(other[2] - cell.place[2]) <= 1)
            visit(cells_[c]);
        }
      }
  }

  double size_m_;
  double floor_m_;
  std::vector<LineCell> cells_;  // in the order met: sums do not depend on the hash
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> columns_;
};

void move_once(std::vector<DrivenPass>& passes, const AttractionOptions& options) {
  Cells cells(options);
  std::vector<std::vector<std::size_t>> cell_of(passes.size());
  for (std::size_t p = 0; p < passes.size(); ++p) {
    const auto& line = passes[p].positions;
    for (std::size_t i = 0; i < line.size(); ++i) {
      // Over several steps: a shift from cell to cell turns a single step.
      const std::size_t before = i < 3 ? 0 : i - 3;
      const std::size_t after = std::min(i + 3, line.size() - 1);
      cell_of[p].push_back(cells.add(line[i], line[after] - line[before]));
    }
  }
  const std::vector<Eigen::Vector2d> shifts = cells.shifts(options.width_m);
  for (std::size_t p = 0; p < passes.size(); ++p)
    for (std::size_t i = 0; i < cell_of[p].size(); ++i)
      passes[p].positions[i].head<2>() += shifts[cell_of[p][i]];
}

}  // namespace

std::vector<DrivenPass> attract_passes(const std::vector<DrivenPass>& passes,
                                       const AttractionOptions& options) {
  std::vector<DrivenPass> moved = passes;
  for (DrivenPass& pass : moved) pass.positions = resample(pass, options.step_m).points;
  for (int round = 0; round < options.rounds; ++round) move_once(moved, options);
  return moved;
}

}  // namespace roadbook
