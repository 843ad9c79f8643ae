#include "mapping/occupancy/known_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/occupancy/cell_rules.hpp"

namespace roadbook {
namespace {

constexpr double kEchoes = 0.9;     // probability of a surface; lower ones take people for surfaces
constexpr double kOccupied = 0.65;  // of a cell under wide beams
constexpr std::uint32_t kFewestEchoes = 2;

}  // namespace

KnownSurfaces::KnownSurfaces(const PatchGrid& first, double prior_log_odds, double cone_rad)
    : shape_(first), known_(first.size(), 0) {
  const int reach = std::max(1, static_cast<int>(std::lround(kBetweenEchoes_m / shape_.cell_m)));
  own_ += reach;
  const double threshold = log_odds(cone_rad > 0.0 ? kOccupied : kEchoes) - prior_log_odds;
  if (cone_rad > 0.0)
    know_around_occupied(first, threshold, reach);
  else
    know_around_echoes(first, threshold, reach);
}

template <typename Visit>
void KnownSurfaces::for_each_near(int column, int row, int reach, const Visit& visit) const {
  for (int y = std::max(0, row - reach); y <= std::min(row + reach, shape_.rows - 1); ++y)
    for (int x = std::max(0, column - reach); x <= std::min(column + reach, shape_.columns - 1);
         ++x)
      visit(shape_.index(x, y));
}

void KnownSurfaces::know_around_echoes(const PatchGrid& first, double threshold, int reach) {
  std::vector<std::uint32_t> echoes(first.size(), 0);
  std::vector<double> change(first.size(), 0.0);
  for (int r = 0; r < shape_.rows; ++r)
    for (int c = 0; c < shape_.columns; ++c) {
      const std::size_t i = shape_.index(c, r);
      if (first.hits[i] == 0) continue;
      for_each_near(c, r, reach, [&](std::size_t near) {
        echoes[near] += first.hits[i];
        change[near] += static_cast<double>(first.cells[i].change);
      });
    }
  for (std::size_t i = 0; i < known_.size(); ++i)
    known_[i] = echoes[i] >= kFewestEchoes && change[i] > threshold ? 1 : 0;
}

void KnownSurfaces::know_around_occupied(const PatchGrid& first, double threshold, int reach) {
  for (int r = 0; r < shape_.rows; ++r)
    for (int c = 0; c < shape_.columns; ++c) {
      if (!(static_cast<double>(first.cells[shape_.index(c, r)].change) > threshold)) continue;
      for_each_near(c, r, reach, [&](std::size_t near) { known_[near] = 1; });
    }
}

double KnownSurfaces::limit_m(const Eigen::Vector2d& origin,
                              const Eigen::Vector2d& along,
                              double read_m) const {
  const auto entries = static_cast<std::size_t>(read_m / shape_.cell_m);
  const BeamSteps steps(shape_, origin, along, shape_.cell_m, entries);
  // A ray at grazing incidence runs within the surface on which it ends: known cells that go on up
  // to there limit nothing.
  int first = -1;
  for (int k = 0; k < steps.count - own_; ++k) {
    const bool known = known_[steps.cell(k)] != 0;
    if (known && first < 0) first = k;
    if (!known && first >= 0)
      return static_cast<double>(steps.entry + first * steps.entry_slope) / 65536.0 * shape_.cell_m;
  }
  return INFINITY;
}

ConeLimits::ConeLimits(const KnownSurfaces& known,
                       const CellShape& shape,
                       const Eigen::Vector2d& origin,
                       const Eigen::Vector2d& along,
                       double cone_rad,
                       double read_m)
    : origin_(origin), along_(along), half_rad_(0.5 * cone_rad) {
  const int steps = std::max(1, static_cast<int>(std::ceil(cone_rad * read_m / shape.cell_m)));
  step_rad_ = cone_rad / steps;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d ray = Eigen::Rotation2Dd(i * step_rad_ - half_rad_) * along;
    limits_m_.push_back(known.limit_m(origin, ray, read_m));
  }
}

bool ConeLimits::holds(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d d = place - origin_;
  const double a = std::atan2(along_.x() * d.y() - along_.y() * d.x(), along_.dot(d));
  const double last = static_cast<double>(limits_m_.size() - 1);
  const double i = std::clamp(std::round((a + half_rad_) / step_rad_), 0.0, last);
  return d.norm() < limits_m_[static_cast<std::size_t>(i)];
}

}  // namespace roadbook
