#include "sensors/range/inverse_range.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

constexpr double kDiagonal = 0.42;  // how much longer than a side the longest chord is

double logit(double p) { return std::log(p) - std::log1p(-p); }

double below(double u) { return 0.5 * std::erfc(-u / std::numbers::sqrt2); }

// Mean density of a hit at `z` over first surfaces between `near` and `far`.
double mean_hit(double z, double near, double far, double sigma) {
  constexpr double kReach = 9.0;
  if (near > z + kReach * sigma || far < z - kReach * sigma) return 0.0;
  return (below((z - near) / sigma) - below((z - far) / sigma)) / (far - near);
}

// The forward model of a reading for a first surface in [near, far] or beyond the maximum range.
class ForwardModel {
 public:
  ForwardModel(const RangeMixture& m, double max_m, double step_m)
      : m_(m), max_m_(max_m), rounded_var_(step_m * step_m / 12.0) {}

  [[nodiscard]] double of(double z, double near, double far) const {
    const double r = 0.5 * (near + far);
    if (is_maximum(z, max_m_)) {
      const double beyond = 1.0 - below((max_m_ - r) / m_.sigma_m);
      return m_.share[kMaximum] + m_.hit() * (m_.anything + (1.0 - m_.anything) * beyond);
    }
    double hit = (1.0 - m_.wide) * mean_hit(z, near, far, smeared(m_.sigma_m));
    if (m_.wide > 0.0) hit += m_.wide * mean_hit(z, near, far, smeared(kWideHit * m_.sigma_m));
    double sum = m_.hit() * ((1.0 - m_.anything) * hit + m_.anything / max_m_) +
                 m_.share[kCrosstalk] / max_m_;
    if (m_.share[kOutliers] > 0.0)
      sum += m_.share[kOutliers] * mean_hit(z, near, far, smeared(m_.outlier * m_.sigma_m));
    if (z <= far) sum += m_.share[kShort] * short_density(z, std::max(r, z));
    return sum;
  }
  [[nodiscard]] double of_nothing(double z) const {
    if (is_maximum(z, max_m_)) return m_.share[kMaximum] + m_.hit() + m_.share[kOutliers];
    return (m_.share[kCrosstalk] + m_.hit() * m_.anything) / max_m_ +
           m_.share[kShort] * short_density(z, max_m_);
  }

 private:
  [[nodiscard]] double smeared(double sigma) const {
    return std::sqrt(sigma * sigma + rounded_var_);
  }
  [[nodiscard]] double short_density(double z, double r) const {
    const double rate = m_.short_rate_per_m;
    return rate * std::exp(-rate * z) / -std::expm1(-rate * std::max(r, 1e-6));
  }

  const RangeMixture& m_;
  double max_m_;
  double rounded_var_;  // of a reading that is rounded to the table's step
};

// Prior of the first surface along a beam, by steps of the table.
struct BeamPrior {
  std::vector<double> first;  ///< probability that the first surface lies in the step
  std::vector<double> share;  ///< of that probability, for one cell of the ring at this distance
  double nothing = 1.0;       ///< probability that there is no surface within the maximum range

  BeamPrior(std::size_t steps, double step_m, const InverseRangeOptions& o)
      : first(steps), share(steps) {
    const double one = -std::expm1(-o.surfaces_per_m * step_m);
    for (std::size_t i = 0; i < steps; ++i) {
      const double r = (static_cast<double>(i) + 0.5) * step_m;
      const double cells = std::max(1.0, o.cone_rad * r / o.cell_m);
      const double any = -std::expm1(-o.surfaces_per_m * step_m * cells);
      first[i] = nothing * any;
      share[i] = one / any;
      nothing -= first[i];
    }
  }
};

// Posterior of the first surface as sums from the sensor to each step's begin.
struct BeamPosterior {
  std::vector<double> before;  ///< the first surface lies before this distance
  std::vector<double> held;    ///< and within one given cell of each ring
  double step_m;

  BeamPosterior(double z, const BeamPrior& prior, const ForwardModel& forward, double step)
      : before(prior.first.size() + 1, 0.0), held(before), step_m(step) {
    for (std::size_t i = 0; i < prior.first.size(); ++i) {
      const double near = static_cast<double>(i) * step_m;
      const double joint = prior.first[i] * forward.of(z, near, near + step_m);
      before[i + 1] = before[i] + joint;
      held[i + 1] = held[i] + prior.share[i] * joint;
    }
    const double sum = before.back() + prior.nothing * forward.of_nothing(z);
    for (double& b : before) b /= sum;
    for (double& h : held) h /= sum;
  }
  [[nodiscard]] double at(const std::vector<double>& sums, double distance_m) const {
    const auto steps = static_cast<double>(sums.size() - 1);
    const double x = std::clamp(distance_m / step_m, 0.0, steps);
    const auto i = std::min(static_cast<std::size_t>(x), sums.size() - 2);
    return sums[i] + (x - static_cast<double>(i)) * (sums[i + 1] - sums[i]);
  }
  /// Probability that a cell between two distances is occupied. `prior`: before the reading;
  /// `passed`: if the beam crossed the cell.
  [[nodiscard]] double occupied(double from_m, double to_m, double prior, double passed) const {
    const double in_cell = at(held, to_m) - at(held, from_m);
    const double in_ring = at(before, to_m) - at(before, from_m);
    // Cells of the ring that do not hold the first surface are as unknown as those behind it.
    return in_cell + prior * (at(before, from_m) + in_ring - in_cell) +
           passed * (1.0 - at(before, to_m));
  }
};

}  // namespace

void InverseRangeOptions::check() const {
  const auto require = [](const char* name, double value, double least, double most,
                          const char* want) {
    require_option(value >= least && value <= most, name, value, want);
  };
  require("cell_m", cell_m, 0.005, 10.0, "0.005 to 10");
  require("surfaces_per_m", surfaces_per_m, 1e-5, 100.0, "1e-5 to 100");
  require("cone_rad", cone_rad, 0.0, 3.15, "0 to 3.15");
  require("met", met, 0.05, 1.0, "0.05 to 1");
  require("most_log_odds", most_log_odds, 0.1, 30.0, "0.1 to 30");
}

InverseRangeModel::InverseRangeModel(const RangeMixture& mixture,
                                     double max_m,
                                     const InverseRangeOptions& options)
    : max_m_(max_m), cell_m_(options.cell_m), met_(options.cone_rad > 0.0 ? 1.0 : options.met) {
  options.check();
  constexpr double kMostSteps = 2000.0;
  step_m_ = std::max(0.5 * cell_m_, max_m / kMostSteps);
  constexpr double kMostPrior = 0.5;
  prior_ = std::min(kMostPrior, -std::expm1(-options.surfaces_per_m * cell_m_) / met_);
  const double passed = prior_ * (1.0 - met_) / (1.0 - prior_ * met_);
  width_ = static_cast<std::size_t>(std::ceil(max_m / step_m_));
  rows_ = width_ + 2;
  ends_.resize(rows_);
  for (auto& table : table_) table.assign(rows_ * width_, 0.0F);
  const ForwardModel forward(mixture, max_m, step_m_);
  const BeamPrior prior(width_, step_m_, options);
  for (std::size_t row = 0; row < rows_; ++row) {
    const bool maximum = row + 1 == rows_;
    const double z = maximum ? max_m : std::min(static_cast<double>(row) * step_m_, max_m - 1e-6);
    const double end = std::ceil((z + 0.75 * cell_m_) / step_m_);
    ends_[row] = maximum ? width_ : std::min(width_, static_cast<std::size_t>(end));
    const BeamPosterior posterior(z, prior, forward, step_m_);
    for (std::size_t chord = 0; chord < kChords; ++chord)
      fill_row(row, chord, options, [&](double from_m, double to_m) {
        return posterior.occupied(std::max(0.0, from_m), to_m, prior_, passed);
      });
  }
}

template <typename Occupied>
void InverseRangeModel::fill_row(std::size_t row,
                                 std::size_t chord,
                                 const InverseRangeOptions& options,
                                 const Occupied& occupied) {
  const double length = 1.0 + kDiagonal * static_cast<double>(chord) / (kChords - 1);
  const double half = 0.5 * cell_m_ * length;
  for (std::size_t i = 0; i < ends_[row]; ++i) {
    const double middle = static_cast<double>(i) * step_m_;
    const double p = std::clamp(occupied(middle - half, middle + half), 1e-12, 1.0 - 1e-12);
    const double change = logit(p) - logit(prior_);
    table_[chord][row * width_ + i] =
        static_cast<float>(std::clamp(change, -options.most_log_odds, options.most_log_odds));
  }
}

double InverseRangeModel::prior_log_odds() const { return logit(prior_); }

std::span<const float> InverseRangeModel::changes(double read_m, double chord_m) const {
  const std::size_t row =
      is_maximum(read_m, max_m_)
          ? rows_ - 1
          : std::min(rows_ - 2, static_cast<std::size_t>(read_m / step_m_ + 0.5));
  const auto chord = static_cast<std::size_t>(
      std::clamp((chord_m / cell_m_ - 1.0) / kDiagonal * (kChords - 1) + 0.5, 0.0, kChords - 1.0));
  return {table_[chord].data() + row * width_, ends_[row]};
}

}  // namespace roadbook
