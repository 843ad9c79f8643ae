#include "diagnosis/friction/inferred_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/numerics/place_basis.hpp"

namespace roadbook {
namespace {

constexpr double kLeastGap = 0.15;      // between neighbouring groups
constexpr double kPlaceScatter = 0.02;  // standard deviation of place means on one surface
constexpr std::size_t kMostGroups = 5;
constexpr double kFewestOfCell = 3.0;  // least readings of a usable cell

struct Cell {
  double mean = 0.0;
  double weight = 0.0;
};

// Mean and weight of each cell, from the scatter of its readings.
std::vector<Cell> cell_means(const std::vector<FrictionSample>& samples, const PlaceCells& cells) {
  std::vector<double> count(cells.centres.size()), sum(count), squares(count);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    count[cells.of[i]] += 1.0;
    sum[cells.of[i]] += samples[i].friction;
    squares[cells.of[i]] += samples[i].friction * samples[i].friction;
  }
  double scatter = 0.0, freedom = 0.0;
  for (std::size_t c = 0; c < count.size(); ++c) {
    scatter += squares[c] - sum[c] * sum[c] / std::max(count[c], 1.0);
    freedom += std::max(count[c] - 1.0, 0.0);
  }
  const double variance = freedom > 0.0 ? scatter / freedom : 0.0025;
  std::vector<Cell> means;
  for (std::size_t c = 0; c < count.size(); ++c) {
    const double of_mean = variance / std::max(count[c], 1.0) + kPlaceScatter * kPlaceScatter;
    means.push_back(
        {sum[c] / std::max(count[c], 1.0), count[c] < kFewestOfCell ? 0.0 : 1.0 / of_mean});
  }
  return means;
}

// Groups of sorted cells with the least weighted sum of squares, for 1 to kMostGroups groups.
class Grouping {
 public:
  explicit Grouping(const std::vector<Cell>& sorted) : n_(sorted.size()), sums_(n_ + 1) {
    for (std::size_t i = 0; i < n_; ++i) {
      const auto& [mean, weight] = sorted[i];
      sums_[i + 1] = {sums_[i].weight + weight, sums_[i].first + weight * mean,
                      sums_[i].second + weight * mean * mean};
    }
    best_.assign(kMostGroups + 1, std::vector<double>(n_ + 1, kNever));
    from_.assign(kMostGroups + 1, std::vector<std::size_t>(n_ + 1, 0));
    best_[0][0] = 0.0;
    for (std::size_t k = 1; k <= kMostGroups; ++k)
      for (std::size_t end = k; end <= n_; ++end)
        for (std::size_t begin = k - 1; begin < end; ++begin) {
          const double cost = best_[k - 1][begin] + squares(begin, end);
          if (cost >= best_[k][end]) continue;
          best_[k][end] = cost;
          from_[k][end] = begin;
        }
  }
  // Bayesian information criterion; each further group has two parameters, its mean and its border.
  [[nodiscard]] double criterion(std::size_t groups) const {
    return best_[groups][n_] + 2.0 * static_cast<double>(groups) *
                                   std::log(static_cast<double>(std::max<std::size_t>(n_, 2)));
  }
  [[nodiscard]] std::vector<double> means(std::size_t groups) const {
    std::vector<double> all;
    std::size_t end = n_;
    for (std::size_t k = groups; k > 0; --k) {
      const std::size_t begin = from_[k][end];
      all.push_back((sums_[end].first - sums_[begin].first) /
                    (sums_[end].weight - sums_[begin].weight));
      end = begin;
    }
    return all;  // descending
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  struct Sums {
    double weight = 0.0, first = 0.0, second = 0.0;
  };
  [[nodiscard]] double squares(std::size_t begin, std::size_t end) const {
    const Sums &a = sums_[begin], &b = sums_[end];
    const double first = b.first - a.first;
    return b.second - a.second - first * first / (b.weight - a.weight);
  }
  std::size_t n_;
  std::vector<Sums> sums_;
  std::vector<std::vector<double>> best_;
  std::vector<std::vector<std::size_t>> from_;
};

std::vector<double> group_means(std::vector<Cell> cells) {
  std::erase_if(cells, [](const Cell& c) { return c.weight <= 0.0; });
  if (cells.empty()) return {0.0};
  std::sort(cells.begin(), cells.end(),
            [](const Cell& a, const Cell& b) { return a.mean < b.mean; });
  const Grouping grouping(cells);
  std::vector<double> chosen = grouping.means(1);
  double least = grouping.criterion(1);
  for (std::size_t k = 2; k <= std::min(kMostGroups, cells.size()); ++k) {
    const std::vector<double> means = grouping.means(k);
    bool apart = true;
    for (std::size_t i = 1; i < means.size(); ++i) apart &= means[i - 1] - means[i] >= kLeastGap;
    if (!apart || grouping.criterion(k) >= least) continue;
    least = grouping.criterion(k);
    chosen = means;
  }
  return chosen;
}

}  // namespace

std::vector<int> inferred_surfaces(const std::vector<FrictionSample>& samples) {
  std::vector<Eigen::Vector2d> places;
  for (const FrictionSample& s : samples) places.emplace_back(s.x, s.y);
  const PlaceCells cells = place_cells(places);
  const std::vector<Cell> cell = cell_means(samples, cells);
  const std::vector<double> means = group_means(cell);
  std::vector<int> of(samples.size(), 0);
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t k = 1; k < means.size(); ++k)
      if (std::abs(cell[cells.of[i]].mean - means[k]) <
          std::abs(cell[cells.of[i]].mean - means[static_cast<std::size_t>(of[i])]))
        of[i] = static_cast<int>(k);
  return of;
}

}  // namespace roadbook
