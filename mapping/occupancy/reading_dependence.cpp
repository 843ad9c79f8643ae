#include "mapping/occupancy/reading_dependence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "mapping/occupancy/cell_rules.hpp"
#include "mapping/occupancy/patch_grid.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMostScans = 3000;
constexpr std::size_t kMostLags = 60;
constexpr double kLeastCorrelation = 0.02;

struct SampledCell {
  double belief = 0.0;  // change of the log odds
  std::vector<float> innovations;
};

bool is_sampled(std::size_t cell) {
  return ((static_cast<std::uint64_t>(cell) * 0x9E3779B97F4A7C15U) >> 61) == 0;
}

CellShape shape_of_scans(std::span<const RangeScan> scans, double max_m, double cell_m) {
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d most = -least;
  for (const RangeScan& scan : scans) {
    least = least.cwiseMin(scan.origin);
    most = most.cwiseMax(scan.origin);
  }
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(max_m + 2.0 * cell_m);
  return CellShape::over(least - reach, most + reach, cell_m);
}

// Probabilities that a beam that reaches a cell ends there.
struct EndProbability {
  double occupied;
  double free;
};

EndProbability end_probability(const RangeMixture& m, double met, double max_m, double cell_m) {
  const double within = std::erf(0.5 * cell_m / (m.sigma_m * std::sqrt(2.0)));
  return {m.hit() * met * within,
          cell_m * (m.share[kShort] * m.short_rate_per_m + m.share[kCrosstalk] / max_m)};
}

class Innovations {
 public:
  Innovations(const InverseRangeModel& inverse, const EndProbability& ends)
      : inverse_(inverse), ends_(ends) {}

  void add(std::size_t cell, bool ended, float change) {
    if (!is_sampled(cell)) return;
    SampledCell& one = cells_[cell];
    const double p = probability_of(inverse_.prior_log_odds() + one.belief);
    const double expected = p * ends_.occupied + (1.0 - p) * ends_.free;
    one.innovations.push_back(static_cast<float>((ended ? 1.0 : 0.0) - expected));
    constexpr double kMostBelief = 12.0;
    one.belief = std::clamp(one.belief + static_cast<double>(change), -kMostBelief, kMostBelief);
  }
  // Sums over the cells in ascending order: the same for any hash.
  [[nodiscard]] ReadingDependence result() const {
    std::vector<std::size_t> order;
    for (const auto& [cell, one] : cells_) order.push_back(cell);
    std::sort(order.begin(), order.end());
    ReadingDependence d;
    double squares = 0.0;
    std::vector<double> products(kMostLags, 0.0);
    for (const std::size_t cell : order) {
      const auto& e = cells_.at(cell).innovations;
      d.innovations += e.size();
      for (std::size_t i = 0; i < e.size(); ++i) {
        squares += static_cast<double>(e[i]) * static_cast<double>(e[i]);
        for (std::size_t lag = 1; lag <= kMostLags && i + lag < e.size(); ++lag)
          products[lag - 1] += static_cast<double>(e[i]) * static_cast<double>(e[i + lag]);
      }
    }
    double sum = 0.0;
    for (const double product : products) {
      const double rho = squares > 0.0 ? product / squares : 0.0;
      if (rho < kLeastCorrelation) break;
      d.autocorrelation.push_back(rho);
      sum += rho;
    }
    d.effective_share = 1.0 / (1.0 + 2.0 * sum);
    return d;
  }

 private:
  const InverseRangeModel& inverse_;
  EndProbability ends_;
  std::unordered_map<std::size_t, SampledCell> cells_;
};

}  // namespace

ReadingDependence reading_dependence(std::span<const RangeScan> scans,
                                     const RangeMixture& mixture,
                                     const InverseRangeModel& inverse,
                                     double cell_m,
                                     double cone_rad) {
  scans = scans.first(std::min(scans.size(), kMostScans));
  if (scans.empty()) return {};
  const CellShape shape = shape_of_scans(scans, inverse.max_m(), cell_m);
  Innovations innovations(inverse,
                          end_probability(mixture, inverse.met(), inverse.max_m(), cell_m));
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams) {
      const Eigen::Vector2d along = b.along.cast<double>().normalized();
      const double read = std::min(b.read_m, inverse.max_m());
      const auto row = inverse.changes(read, cell_m / along.cwiseAbs().maxCoeff());
      const bool open = is_maximum(read, inverse.max_m());
      const auto ends_at = [&](std::size_t entry) {
        return !open && std::abs(static_cast<double>(entry) * inverse.step_m() - read) <=
                            0.5 * cell_m + 1e-9;
      };
      const auto add = [&](std::size_t cell, std::size_t entry) {
        // Cells behind the end say nothing.
        if (static_cast<double>(entry) * inverse.step_m() > read + 0.5 * cell_m) return;
        innovations.add(cell, ends_at(entry), row[entry]);
      };
      if (cone_rad > 0.0) {
        for_each_cone_cell(shape, scan.origin, along, cone_rad, inverse.step_m(), row.size(), add);
        continue;
      }
      const BeamSteps steps(shape, scan.origin, along, inverse.step_m(), row.size());
      for (int k = 0; k < steps.count; ++k)
        add(steps.cell(k), static_cast<std::size_t>((steps.entry + k * steps.entry_slope) >> 16));
    }
  return innovations.result();
}

}  // namespace roadbook
