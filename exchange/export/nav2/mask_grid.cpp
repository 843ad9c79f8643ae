#include "exchange/export/nav2/mask_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr double kMostCells = 134217728.0;  // 2^27: what a robot's computer holds several times

}  // namespace

MaskGrid::MaskGrid(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double resolution_m) {
  ROADBOOK_ASSERT((high - low).minCoeff() >= 0.0 && resolution_m > 0.0);
  place_.resolution_m = resolution_m;
  const Eigen::Vector2d first = ((low / resolution_m).array() + 1e-9).floor();
  const Eigen::Vector2d last = ((high / resolution_m).array() - 1e-9).ceil();
  const Eigen::Vector2d count = (last - first).cwiseMax(1.0);
  if (!(count.prod() <= kMostCells)) {
    const double fits = resolution_m * std::sqrt(count.prod() / kMostCells);
    throw InvalidOption("--resolution-m", std::to_string(resolution_m),
                        "at least " + std::to_string(std::ceil(100.0 * fits) / 100.0) +
                            ": the place is " + std::to_string(std::lround((high - low).x())) +
                            " x " + std::to_string(std::lround((high - low).y())) + " m");
  }
  place_.west_m = first.x() * resolution_m;
  place_.north_m = std::max(last.y(), first.y() + 1.0) * resolution_m;
  place_.columns = static_cast<int>(count.x());
  place_.rows = static_cast<int>(count.y());
  cells_.assign(static_cast<std::size_t>(place_.columns) * static_cast<std::size_t>(place_.rows),
                0);
}

int MaskGrid::column_of(double x) const {
  return static_cast<int>(std::floor((x - place_.west_m) / place_.resolution_m));
}

int MaskGrid::row_of(double y) const {
  return static_cast<int>(std::floor((place_.north_m - y) / place_.resolution_m));
}

Eigen::Vector2d MaskGrid::centre(int column, int row) const {
  return {place_.west_m + (column + 0.5) * place_.resolution_m,
          place_.north_m - (row + 0.5) * place_.resolution_m};
}

void MaskGrid::fill(int row, double from_x, double to_x, std::uint8_t value) {
  constexpr double kTouch = 1e-9;  // [m]
  const int first = std::max(0, column_of(from_x - kTouch));
  const int last = std::min(place_.columns - 1, column_of(to_x + kTouch));
  for (int column = first; column <= last; ++column) cells_[index(column, row)] = value;
}

// A cell is touched if an edge passes through it, or if its middle lies within the ring.
void MaskGrid::mark_row(const std::vector<Eigen::Vector2d>& ring, int row, std::uint8_t value) {
  const double top = place_.north_m - row * place_.resolution_m;
  const double bottom = top - place_.resolution_m;
  const double middle = 0.5 * (top + bottom);
  std::vector<double> crossings;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    Eigen::Vector2d a = ring[i];
    Eigen::Vector2d b = ring[(i + 1) % ring.size()];
    if (a.y() > b.y()) std::swap(a, b);
    if (b.y() < bottom || a.y() > top) continue;
    const auto x_at = [&](double y) {
      return b.y() > a.y() ? a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) : a.x();
    };
    const double from = a.y() < bottom ? x_at(bottom) : a.x();
    const double to = b.y() > top ? x_at(top) : b.x();
    fill(row, std::min(from, to), std::max(from, to), value);
    if (a.y() <= middle && b.y() > middle) crossings.push_back(x_at(middle));
  }
  std::sort(crossings.begin(), crossings.end());
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    fill(row, crossings[i], crossings[i + 1], value);
}

void MaskGrid::mark(const std::vector<Eigen::Vector2d>& ring, std::uint8_t value) {
  if (ring.empty()) return;
  double low = ring.front().y();
  double high = low;
  for (const Eigen::Vector2d& p : ring) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const int first = std::max(0, row_of(high + 1e-9));
  const int last = std::min(place_.rows - 1, row_of(low - 1e-9));
  for (int row = first; row <= last; ++row) mark_row(ring, row, value);
}

}  // namespace roadbook
