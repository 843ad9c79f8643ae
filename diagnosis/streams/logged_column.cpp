#include "diagnosis/streams/logged_column.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace roadbook {
namespace {

constexpr std::size_t kFewestLogged = 10;  // least number of readings within the drive
constexpr double kLeastCovered = 0.5;      // least covered share of the drive's duration
constexpr double kLookEvery_s = 0.1;   // [s] sampling interval of a column for its mean and spread
constexpr double kGapIntervals = 5.0;  // [median intervals]
constexpr double kShortestGap = 0.5;   // [s]
constexpr double kLeastSpread = 1e-6;  // relative to the mean
constexpr double kLeastBend = 0.03;    // share of the variance of z^2; less: only two values

double usual_interval(const std::vector<double>& t_s) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < t_s.size(); ++k) steps.push_back(t_s[k] - t_s[k - 1]);
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Few readings within the drive may result from a wrong unit of time in the description.
std::string few_readings(const LoggedColumn& column,
                         std::size_t inside,
                         double from_s,
                         double to_s) {
  std::string text = "has " + std::to_string(inside) + " readings in this drive, fewer than " +
                     std::to_string(kFewestLogged);
  if (column.t_s.size() >= kFewestLogged)
    text += " (its stamps: " + short_number(column.t_s.front()) + " to " +
            short_number(column.t_s.back()) + " s, the drive: " + short_number(from_s) + " to " +
            short_number(to_s) + " s)";
  return text;
}

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " %"; }

}  // namespace

ColumnCovariate::ColumnCovariate(const LoggedColumn& column,
                                 double from_s,
                                 double to_s,
                                 std::string& why_not)
    : column_(column),
      longest_gap_s_(std::max(kShortestGap, kGapIntervals * usual_interval(column.t_s))) {
  const auto inside = static_cast<std::size_t>(std::count_if(
      column_.t_s.begin(), column_.t_s.end(), [&](double t) { return t >= from_s && t <= to_s; }));
  std::vector<double> values;
  double looks = 0.0;
  for (double t = from_s; t <= to_s; t += kLookEvery_s, looks += 1.0)
    if (const auto value = at(t)) values.push_back(*value);
  const double covered = static_cast<double>(values.size()) / std::max(looks, 1.0);
  if (inside < kFewestLogged)
    why_not = few_readings(column_, inside, from_s, to_s);
  else if (covered < kLeastCovered)
    why_not = "has values for " + percent(covered) + " of the drive's time, less than half";
  else
    scale(values);
  if (why_not.empty() && spread_ <= kLeastSpread * std::abs(mean_) + 1e-12)
    why_not = "does not vary (" + short_number(mean_) + " throughout)";
}

void ColumnCovariate::scale(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  for (const double v : values) mean_ += v / n;
  double square = 0.0;
  for (const double v : values) square += (v - mean_) * (v - mean_) / n;
  spread_ = std::sqrt(square);
  if (spread_ <= kLeastSpread * std::abs(mean_) + 1e-12) return;
  double fourth = 0.0;
  for (const double v : values) {
    const double z = (v - mean_) / spread_;
    skew_ += z * z * z / n;
    fourth += z * z * z * z / n;
  }
  // Variance of z^2 after regression on z.
  const double left = std::max(0.0, fourth - 1.0 - skew_ * skew_);
  if (left > kLeastBend * kLeastBend * fourth) bend_spread_ = std::sqrt(left);
}

std::string ColumnCovariate::axis() const {
  return column_.unit.empty() ? column_.name : column_.name + " [" + column_.unit + "]";
}

std::optional<double> ColumnCovariate::at(double t_s) const {
  const auto& times = column_.t_s;
  const auto after = std::lower_bound(times.begin(), times.end(), t_s);
  if (after == times.end()) return std::nullopt;
  const auto k = static_cast<std::size_t>(after - times.begin());
  if (*after == t_s) return column_.values[k];
  if (k == 0 || times[k] - times[k - 1] > longest_gap_s_) return std::nullopt;
  const double f = (t_s - times[k - 1]) / (times[k] - times[k - 1]);
  return (1.0 - f) * column_.values[k - 1] + f * column_.values[k];
}

std::array<double, 2> ColumnCovariate::terms_at(double t_s) const {
  const auto value = at(t_s);
  if (!value) return {0.0, 0.0};
  const double z = (*value - mean_) / spread_;
  return {z, bend_spread_ > 0.0 ? bend(z) / bend_spread_ : 0.0};
}

std::vector<ColumnCovariate> column_covariates(const std::vector<LoggedColumn>& columns,
                                               double from_s,
                                               double to_s,
                                               std::vector<std::string>* notes) {
  std::vector<ColumnCovariate> usable;
  for (const LoggedColumn& column : columns) {
    std::string why_not;
    ColumnCovariate covariate(column, from_s, to_s, why_not);
    if (why_not.empty())
      usable.push_back(std::move(covariate));
    else if (notes != nullptr)
      notes->push_back(column.name + " " + why_not +
                       ": effects that depend on it are not observable");
  }
  return usable;
}

}  // namespace roadbook
