#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roadbook {

// Further columns of a log (battery voltage, tyre temperature, gear ...). A sensor may depend on
// any of them, so they are covariates of the generic effects.

/// Readings as logged. Stamps ascend [s], on the clock of the streams.
struct LoggedColumn {
  std::string name;
  std::string unit;  ///< as written in the log, for display; empty: a number
  std::vector<double> t_s;
  std::vector<double> values;
};

/// A column as a covariate: interpolated linearly between readings, without a value outside them
/// and in gaps.
class ColumnCovariate {
 public:
  /// Computes mean and spread over [`from_s`, `to_s`]. If the column has too few readings there or
  /// does not vary, sets `why_not` instead.
  ColumnCovariate(const LoggedColumn& column, double from_s, double to_s, std::string& why_not);

  [[nodiscard]] const std::string& name() const { return column_.name; }
  [[nodiscard]] double mean() const { return mean_; }
  /// Axis label of a plot, for example "tyre_temperature [degC]".
  [[nodiscard]] std::string axis() const;
  /// Value at `t_s`. No value before the first reading, after the last, and in gaps longer than
  /// five usual intervals and 0.5 s.
  [[nodiscard]] std::optional<double> at(double t_s) const;
  /// Two orthogonal basis functions of the value, each with mean 0 and variance 1 over the drive:
  /// the standardised value z, and z^2 without its projection on 1 and z. The second is 0 if the
  /// column has only two values. Both are 0 where the column has no value, as at its mean.
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
  double bend_spread_ = 0.0;  ///< 0 if the column has only two values
};

/// The usable columns, in order: those that vary in [`from_s`, `to_s`]. The reasons why others are
/// unusable are appended to `notes` if that is not null.
[[nodiscard]] std::vector<ColumnCovariate> column_covariates(
    const std::vector<LoggedColumn>& columns,
    double from_s,
    double to_s,
    std::vector<std::string>* notes = nullptr);

}  // namespace roadbook
