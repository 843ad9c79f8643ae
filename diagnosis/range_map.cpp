#include "diagnosis/range_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr double kLeastHits = 3.0;
constexpr double kLeastShare = 0.3;  // of the beams that reach a cell, those that end in it

}  // namespace

RangeMap::RangeMap(const std::vector<RangeBeam>& beams, double max_m, double cell_m)
    : max_m_(max_m), cell_m_(cell_m) {
  for (const RangeBeam& b : beams) {
    if (!ended(b)) continue;
    const Eigen::Vector2d end = b.origin + b.range_m * b.along;
    Cell& cell = cells_[key_of(end)];
    cell.hits += 1.0;
    cell.sum += end;
    cell.squares += end * end.transpose();
  }
  // Only cells with ends are of interest; near its own end a beam passes nothing.
  for (const RangeBeam& b : beams) {
    if (!ended(b)) continue;
    Key last = key_of(b.origin);
    for (double r = 0.5 * cell_m_; r < b.range_m - 2.5 * cell_m_; r += 0.5 * cell_m_) {
      const Key key = key_of(b.origin + r * b.along);
      if (key == last) continue;
      last = key;
      const auto cell = cells_.find(key);
      if (cell != cells_.end()) cell->second.passes += 1.0;
    }
  }
}

bool RangeMap::ended(const RangeBeam& beam) const {
  return beam.range_m < max_m_ - 1e-9 && beam.range_m > 0.0;
}

RangeMap::Key RangeMap::key_of(const Eigen::Vector2d& place) const {
  const auto i = static_cast<std::int64_t>(std::floor(place.x() / cell_m_));
  const auto j = static_cast<std::int64_t>(std::floor(place.y() / cell_m_));
  return i * (std::int64_t{1} << 32) + j;
}

std::optional<double> RangeMap::first_surface(const RangeBeam& beam,
                                              const Eigen::Vector2d& origin) const {
  const bool own = ended(beam);
  const Key end = key_of(beam.origin + beam.range_m * beam.along);
  for (double r = 0.0; r < max_m_; r += 0.5 * cell_m_) {
    const Key key = key_of(origin + r * beam.along);
    const auto found = cells_.find(key);
    if (found == cells_.end()) continue;
    const double hits = found->second.hits - (own && key == end ? 1.0 : 0.0);
    if (hits >= kLeastHits && hits >= kLeastShare * (hits + found->second.passes)) return r;
  }
  return std::nullopt;
}

std::optional<double> RangeMap::at_line(const RangeBeam& beam, double near_m) const {
  const Eigen::Vector2d place = beam.origin + (near_m + 0.5 * cell_m_) * beam.along;
  const Eigen::Vector2d end = beam.origin + beam.range_m * beam.along;
  Cell all;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) {
      const Key key = key_of(place + cell_m_ * Eigen::Vector2d(i, j));
      const auto found = cells_.find(key);
      if (found == cells_.end()) continue;
      all.hits += found->second.hits;
      all.sum += found->second.sum;
      all.squares += found->second.squares;
      if (!ended(beam) || key != key_of(end)) continue;
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
  // Points without a direction are a corner or a post; a surface seen from its side is unsure.
  const bool line = shape.eigenvalues()[1] > 6.0 * std::max(shape.eigenvalues()[0], 1e-8);
  if (!line || std::abs(across) < 0.35) return std::nullopt;
  return normal.dot(mean - beam.origin) / across;
}

std::optional<double> RangeMap::expected(const RangeBeam& beam) const {
  const auto middle = first_surface(beam, beam.origin);
  if (!middle) return std::nullopt;
  const Eigen::Vector2d across(-beam.along.y(), beam.along.x());
  for (const double side : {-1.5, 1.5}) {
    const auto beside = first_surface(beam, beam.origin + side * cell_m_ * across);
    // A beam that just misses an edge may as well hit it.
    if (!beside || std::abs(*beside - *middle) > 5.0 * cell_m_) return std::nullopt;
  }
  const auto exact = at_line(beam, *middle);
  if (!exact || std::abs(*exact - *middle) > 3.0 * cell_m_ || *exact >= max_m_) return std::nullopt;
  return exact;
}

}  // namespace roadbook
