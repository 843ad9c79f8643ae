#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roadbook {

// Further columns of a log: what somebody thought worth recording, and what a sensor may therefore
// depend on (battery voltage, temperature of a tyre, gear).

/// Readings as they were logged; stamps ascend, on the clock of the streams.
struct LoggedColumn {
  std::string name;
  std::string unit;  ///< as the log has it, for people; empty: a number
  std::vector<double> t_s;
  std::vector<double> values;
};

/// A column as the grammar sees it: linear between readings, nothing beyond them and in gaps.
class ColumnCovariate {
 public:
  /// Centred and scaled over the time from `from_s` to `to_s`; `why_not` is set instead where it
  /// has too few readings there, or does not vary.
  ColumnCovariate(const LoggedColumn& column, double from_s, double to_s, std::string& why_not);

  [[nodiscard]] const std::string& name() const { return column_.name; }
  [[nodiscard]] double mean() const { return mean_; }
  /// "tyre_temperature [degC]"
  [[nodiscard]] std::string axis() const;
  /// Empty before the first reading, after the last, and where neighbours lie more than five usual
  /// intervals (and half a second) apart.
  [[nodiscard]] std::optional<double> at(double t_s) const;
  /// Smooth functions of the value: itself in units of its spread, less its mean, and, where it
  /// has more than two values, the square of that without what the first says of it, in units of
  /// its own spread. All 0 where there is no value: as at the mean.
  [[nodiscard]] std::array<double, 2> terms_at(double t_s) const;
  [[nodiscard]] std::size_t terms() const { return bend_spread_ > 0.0 ? 2 : 1; }

 private:
  void scale(const std::vector<double>& values);
  [[nodiscard]] double bend(double z) const { return z * z - 1.0 - skew_ * z; }

  LoggedColumn column_;
  double longest_gap_s_ = 0.0;
  double mean_ = 0.0;
  double spread_ = 1.0;
  double skew_ = 0.0;
  double bend_spread_ = 0.0;  ///< 0: two values have no bend
};

/// The columns that vary while the poses go on, in order; what is not to be used, and why, goes to
/// `notes` where that is not null.
[[nodiscard]] std::vector<ColumnCovariate> column_covariates(
    const std::vector<LoggedColumn>& columns,
    double from_s,
    double to_s,
    std::vector<std::string>* notes = nullptr);

}  // namespace roadbook
