#include "speedmap/fields/occupancy_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr double kMostLogOdds = 16.0;
constexpr int kReach = 2;  // cells: the kernel reaches two cells to each side

// Weights of the four cells around a point at the share `t` between the second and the third, and
// their derivatives by `t` [Keys 1981, eq. 15, a = -1/2].
struct CubicWeights {
  std::array<double, 4> value;
  std::array<double, 4> slope;

  explicit CubicWeights(double t)
      : value{((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
              ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t},
        slope{(-1.5 * t + 2.0) * t - 0.5, (4.5 * t - 5.0) * t, (-4.5 * t + 4.0) * t + 0.5,
              (1.5 * t - 1.0) * t} {}
};

}  // namespace

OccupancyField::OccupancyField(OccupancyCells cells) : cells_(std::move(cells)) {
  const std::size_t size = static_cast<std::size_t>(std::max(0, cells_.columns)) *
                           static_cast<std::size_t>(std::max(0, cells_.rows));
  if (!(cells_.cell_m > 0.0) || size == 0 || cells_.probability.size() != size ||
      cells_.sigma.size() != size || cells_.age_s.size() != size)
    throw InvalidOption("occupancy", std::to_string(cells_.probability.size()) + " cells",
                        std::to_string(size) + " with probability, sigma and age");
  log_odds_.reserve(size);
  for (const float p : cells_.probability) {
    if (!std::isnan(p) && !(p >= 0.0F && p <= 1.0F))
      throw InvalidOption("occupancy", std::to_string(p), "a probability from 0 to 1");
    const double odds = std::log(static_cast<double>(p)) - std::log1p(-static_cast<double>(p));
    log_odds_.push_back(
        std::isnan(p) ? NAN : static_cast<float>(std::clamp(odds, -kMostLogOdds, kMostLogOdds)));
  }
  extend();
}

// Cells outside the grid are as those on its edge.
float OccupancyField::log_odds(int column, int row) const {
  const auto c = static_cast<std::size_t>(std::clamp(column, 0, cells_.columns - 1));
  const auto r = static_cast<std::size_t>(std::clamp(row, 0, cells_.rows - 1));
  return log_odds_[r * static_cast<std::size_t>(cells_.columns) + c];
}

// Gives the cells around the known ones the mean of their neighbours, as far as the kernel reaches.
void OccupancyField::extend() {
  for (int round = 0; round < kReach; ++round) {
    std::vector<float> next = log_odds_;
    for (int r = 0; r < cells_.rows; ++r)
      for (int c = 0; c < cells_.columns; ++c) {
        float& cell = next[static_cast<std::size_t>(r) * static_cast<std::size_t>(cells_.columns) +
                           static_cast<std::size_t>(c)];
        if (!std::isnan(cell)) continue;
        double sum = 0.0;
        int count = 0;
        for (int dr = -1; dr <= 1; ++dr)
          for (int dc = -1; dc <= 1; ++dc)
            if (const float near = log_odds(c + dc, r + dr); !std::isnan(near)) {
              sum += near;
              ++count;
            }
        if (count > 0) cell = static_cast<float>(sum / count);
      }
    log_odds_ = std::move(next);
  }
}

std::optional<OccupancyAt> OccupancyField::at(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d q = (p - cells_.low) / cells_.cell_m;
  if (!(q.x() >= 0.0 && q.y() >= 0.0 && q.x() < cells_.columns && q.y() < cells_.rows))
    return std::nullopt;
  const auto cell = static_cast<std::size_t>(q.y()) * static_cast<std::size_t>(cells_.columns) +
                    static_cast<std::size_t>(q.x());
  if (std::isnan(cells_.probability[cell])) return std::nullopt;
  // The middle of cell i lies at i + 1/2.
  const Eigen::Vector2d m = q.array() - 0.5;
  const Eigen::Vector2d first = m.array().floor();
  const CubicWeights x(m.x() - first.x());
  const CubicWeights y(m.y() - first.y());
  const int column = static_cast<int>(first.x()) - 1;
  const int row = static_cast<int>(first.y()) - 1;
  double odds = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  const bool within =
      column >= 0 && row >= 0 && column + 3 < cells_.columns && row + 3 < cells_.rows;
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<double, 4> near{};
    const int at_row = row + static_cast<int>(k);
    if (within) {  // most points: no check of every cell (bench/query_bench)
      const float* const cells =
          &log_odds_[static_cast<std::size_t>(at_row) * static_cast<std::size_t>(cells_.columns) +
                     static_cast<std::size_t>(column)];
      for (std::size_t i = 0; i < 4; ++i) near[i] = static_cast<double>(cells[i]);
    } else {
      for (std::size_t i = 0; i < 4; ++i)
        near[i] = static_cast<double>(log_odds(column + static_cast<int>(i), at_row));
    }
    double value = 0.0;
    double along = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      value += x.value[i] * near[i];
      along += x.slope[i] * near[i];
    }
    odds += y.value[k] * value;
    slope += Eigen::Vector2d(y.value[k] * along, y.slope[k] * value);
  }
  OccupancyAt at;
  at.probability = 1.0 / (1.0 + std::exp(-odds));
  at.gradient = at.probability * (1.0 - at.probability) / cells_.cell_m * slope;
  at.sigma = cells_.sigma[cell];
  at.age_s = cells_.age_s[cell];
  return at;
}

}  // namespace roadbook
