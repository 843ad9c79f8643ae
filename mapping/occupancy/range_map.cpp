#include "mapping/occupancy/range_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kLeastHits = 3.0;
constexpr double kSameHeight = 0.12;  // [m]: cars and walls are vertical over this height
constexpr double kLeastEnding = 0.3;  // least share of the beams reaching a cell that end in it

}  // namespace

RangeMap::RangeMap(const std::vector<RangeBeam>& beams, double max_m, double cell_m)
    : max_m_(max_m), cell_m_(cell_m) {
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e300);
  low_ = Eigen::Vector2d::Constant(1e300);
  for (const RangeBeam& b : beams) {
    if (!ended(b)) continue;
    const Eigen::Vector2d end = b.origin + b.range_m * b.along;
    low_ = low_.cwiseMin(end);
    high = high.cwiseMax(end);
  }
  if (low_.x() > high.x()) return;
  // Largest number of grid positions; larger areas get larger cells.
  constexpr double kMost = 3e7;
  while ((high - low_).prod() / (cell_m_ * cell_m_) > kMost) cell_m_ *= 2.0;
  width_ = static_cast<std::int64_t>((high.x() - low_.x()) / cell_m_) + 1;
  height_ = static_cast<std::int64_t>((high.y() - low_.y()) / cell_m_) + 1;
  number_.assign(static_cast<std::size_t>(width_ * height_), -1);
  for (const RangeBeam& b : beams) {
    if (!ended(b)) continue;
    const Eigen::Vector2d end = b.origin + b.range_m * b.along;
    std::int32_t& number = number_[static_cast<std::size_t>(index_of(end))];
    if (number < 0) {
      number = static_cast<std::int32_t>(cells_.size());
      cells_.emplace_back();
    }
    Cell& cell = cells_[static_cast<std::size_t>(number)];
    cell.hits += 1.0;
    cell.heights += b.height_at(b.range_m);
    cell.sum += end;
    cell.squares += end * end.transpose();
  }
  // Counts passes only for cells with ends; the stretch just before a beam's own end does not
  // count.
  for (const RangeBeam& b : beams) {
    if (!ended(b)) continue;
    std::int64_t last = -1;
    for (double r = 0.5 * cell_m_; r < b.range_m - 2.5 * cell_m_; r += 0.5 * cell_m_) {
      const std::int64_t index = index_of(b.origin + r * b.along);
      if (index == last || index < 0) continue;
      last = index;
      const std::int32_t number = number_[static_cast<std::size_t>(index)];
      if (number >= 0) cells_[static_cast<std::size_t>(number)].passes += 1.0;
    }
  }
}

bool RangeMap::ended(const RangeBeam& beam) const {
  return beam.range_m < max_m_ - 1e-9 && beam.range_m > 0.0;
}

std::int64_t RangeMap::index_of(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d at = (place - low_) / cell_m_;
  if (!(at.x() >= 0.0) || !(at.y() >= 0.0)) return -1;
  const auto i = static_cast<std::int64_t>(at.x());
  const auto j = static_cast<std::int64_t>(at.y());
  return i < width_ && j < height_ ? j * width_ + i : -1;
}

const RangeMap::Cell* RangeMap::at(const Eigen::Vector2d& place) const {
  const std::int64_t index = index_of(place);
  if (index < 0) return nullptr;
  const std::int32_t number = number_[static_cast<std::size_t>(index)];
  return number < 0 ? nullptr : &cells_[static_cast<std::size_t>(number)];
}

std::optional<double> RangeMap::first_surface(const RangeBeam& beam,
                                              const Eigen::Vector2d& origin) const {
  const bool own = ended(beam);
  const Cell* const end = at(beam.origin + beam.range_m * beam.along);
  for (double r = 0.0; r < max_m_; r += 0.5 * cell_m_) {
    const Cell* const cell = at(origin + r * beam.along);
    if (cell == nullptr) continue;
    const double mine = own && cell == end ? 1.0 : 0.0;
    const double hits = cell->hits - mine;
    if (hits < kLeastHits) continue;
    const double height = (cell->heights - mine * beam.height_at(beam.range_m)) / hits;
    if (std::abs(height - beam.height_at(r)) > kSameHeight) return std::nullopt;
    if (hits >= kLeastEnding * (hits + cell->passes)) return r;
  }
  return std::nullopt;
}

std::optional<ExpectedSurface> RangeMap::at_line(const RangeBeam& beam, double near_m) const {
  const Eigen::Vector2d place = beam.origin + (near_m + 0.5 * cell_m_) * beam.along;
  const Eigen::Vector2d end = beam.origin + beam.range_m * beam.along;
  Cell all;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const Cell* const cell = at(place + cell_m_ * Eigen::Vector2d(i, j));
      if (cell == nullptr) continue;
      all.hits += cell->hits;
      all.sum += cell->sum;
      all.squares += cell->squares;
      if (!ended(beam) || cell != at(end)) continue;
      all.hits -= 1.0;
      all.sum -= end;
      all.squares -= end * end.transpose();
    }
  if (all.hits < 2.0 * kLeastHits) return std::nullopt;
  const Eigen::Vector2d mean = all.sum / all.hits;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> shape(all.squares / all.hits -
                                                             mean * mean.transpose());
  const Eigen::Vector2d normal = shape.eigenvectors().col(0);
  const double across = normal.dot(beam.along);
  // Points without a clear direction are a corner or a post; a surface at grazing incidence is
  // uncertain.
  const bool line = shape.eigenvalues()[1] > 6.0 * std::max(shape.eigenvalues()[0], 1e-8);
  if (!line || std::abs(across) < 0.35) return std::nullopt;
  return ExpectedSurface{normal.dot(mean - beam.origin) / across, normal};
}

std::optional<ExpectedSurface> RangeMap::surface(const RangeBeam& beam) const {
  const auto middle = first_surface(beam, beam.origin);
  if (!middle) return std::nullopt;
  const Eigen::Vector2d across(-beam.along.y(), beam.along.x());
  for (const double side : {-3.0, -1.5, 1.5, 3.0}) {
    const auto beside = first_surface(beam, beam.origin + side * cell_m_ * across);
    // Close to an edge a beam may hit or miss.
    if (!beside || std::abs(*beside - *middle) > (2.0 + 2.0 * std::abs(side)) * cell_m_)
      return std::nullopt;
  }
  const auto exact = at_line(beam, *middle);
  if (!exact || std::abs(exact->range_m - *middle) > 3.0 * cell_m_ || exact->range_m >= max_m_)
    return std::nullopt;
  return exact;
}

}  // namespace roadbook
