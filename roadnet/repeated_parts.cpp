#include "roadnet/repeated_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <tuple>

#include "roadnet/samples.hpp"

namespace roadbook {
namespace {

constexpr int kDirections = 6;  // of a line without sense: 30 degrees each

using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t, int>;  // x, y, z, direction

class PassCount {
 public:
  PassCount(double radius_m, int min_passes)
      : radius_m_(radius_m), enough_(static_cast<std::size_t>(min_passes)) {}

  [[nodiscard]] Cell cell(const Eigen::Vector3d& p, const Eigen::Vector3d& direction) const {
    const double angle = std::atan2(direction.y(), direction.x()) + std::numbers::pi;
    const int part = static_cast<int>(angle / std::numbers::pi * kDirections) % kDirections;
    const auto index = [this](double v) {
      return static_cast<std::int64_t>(std::floor(v / radius_m_));
    };
    return {index(p.x()), index(p.y()), index(p.z()), part};
  }

  void add(const Cell& cell, int pass) {
    std::vector<int>& list = seen_[cell];
    // A list that is long enough answers every question asked of it.
    if (list.size() < enough_ && (list.empty() || list.back() != pass)) list.push_back(pass);
  }

  [[nodiscard]] bool enough(const Cell& centre) {
    const auto known = answers_.find(centre);
    if (known != answers_.end()) return known->second;
    std::vector<int> all;
    for (std::int64_t k = 0; k < 27; ++k) {
      for (int turn = -1; turn <= 1; ++turn) {
        const auto& [x, y, z, part] = centre;
        const auto at = seen_.find({x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1,
                                    (part + turn + kDirections) % kDirections});
        if (at != seen_.end()) all.insert(all.end(), at->second.begin(), at->second.end());
      }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return answers_[centre] = all.size() >= enough_;
  }

 private:
  double radius_m_;
  std::size_t enough_;
  std::map<Cell, std::vector<int>> seen_;
  std::map<Cell, bool> answers_;
};

// Cells of the steps of one pass; the last position shares the last step's.
std::vector<Cell> cells_of(const std::vector<Eigen::Vector3d>& points, const PassCount& count) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    cells.push_back(count.cell(points[i], points[i + 1] - points[i]));
  }
  if (!cells.empty()) cells.push_back(cells.back());
  return cells;
}

}  // namespace

std::vector<DrivenPass> cut_at_gaps(const std::vector<DrivenPass>& passes, double max_gap_m) {
  std::vector<DrivenPass> parts;
  for (const DrivenPass& pass : passes) {
    for (std::size_t i = 0; i < pass.positions.size(); ++i) {
      const bool gap = i > 0 && max_gap_m > 0.0 &&
                       (pass.positions[i] - pass.positions[i - 1]).norm() > max_gap_m;
      if (i == 0 || gap) parts.push_back({pass.session, pass.reversing, {}});
      parts.back().positions.push_back(pass.positions[i]);
    }
  }
  return parts;
}

std::vector<DrivenPass> gaps(const std::vector<DrivenPass>& passes, double max_gap_m) {
  std::vector<DrivenPass> all;
  if (max_gap_m <= 0.0) return all;
  for (const DrivenPass& pass : passes)
    for (std::size_t i = 0; i + 1 < pass.positions.size(); ++i)
      if ((pass.positions[i + 1] - pass.positions[i]).norm() > max_gap_m)
        all.push_back({pass.session, pass.reversing, {pass.positions[i], pass.positions[i + 1]}});
  return all;
}

std::vector<DrivenPass> repeated_parts(const std::vector<DrivenPass>& passes,
                                       const RepeatedPartsOptions& options) {
  if (options.min_passes <= 1) return passes;
  std::vector<DrivenPass> parts = passes;
  PassCount count(options.radius_m, options.min_passes);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    parts[p].positions = resample(parts[p], options.step_m).points;
    for (const Cell& cell : cells_of(parts[p].positions, count)) {
      count.add(cell, static_cast<int>(p));
    }
  }
  std::vector<DrivenPass> kept;
  for (const DrivenPass& part : parts) {
    const std::vector<Cell> cells = cells_of(part.positions, count);
    bool open = false;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool good = count.enough(cells[i]);
      if (good && !open) kept.push_back({part.session, part.reversing, {}});
      if (good) kept.back().positions.push_back(part.positions[i]);
      open = good;
    }
  }
  return kept;
}

}  // namespace roadbook
