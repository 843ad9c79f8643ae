#include "diagnosis/numerics/sample_difference.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

// Independent values that are worth as much as `values`, by the correlation of neighbours.
double worth(const std::vector<double>& values, const Moments& m) {
  const auto n = static_cast<double>(values.size());
  if (m.sigma <= 0.0) return n;
  double products = 0.0;
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    products += (values[i] - m.mean) * (values[i + 1] - m.mean);
  const double r = std::clamp(products / (n * m.sigma * m.sigma), 0.0, 0.999);
  return std::max(2.0, n * (1.0 - r) / (1.0 + r));
}

// Kolmogorov's distribution, with the correction of Stephens (1970) for small samples.
double p_of(double distance, double n) {
  const double root = std::sqrt(n);
  const double lambda = (root + 0.12 + 0.11 / root) * distance;
  if (lambda < 0.2) return 1.0;  // the sum below converges slowly there, to 1
  double p = 0.0;
  for (int k = 1; k <= 100; ++k)
    p += (k % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * lambda * lambda);
  return std::clamp(p, 0.0, 1.0);
}

double quantile_of(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), sorted.size() - 2);
  const double part = at - static_cast<double>(i);
  return (1.0 - part) * sorted[i] + part * sorted[i + 1];
}

}  // namespace

Moments moments_of(const std::vector<double>& values) {
  ROADBOOK_ASSERT(!values.empty());
  const auto n = static_cast<double>(values.size());
  Moments m;
  for (const double v : values) m.mean += v / n;
  double squares = 0.0;
  for (const double v : values) squares += (v - m.mean) * (v - m.mean);
  m.sigma = std::sqrt(squares / n);
  return m;
}

SampleDifference compare_samples(const std::vector<double>& first,
                                 const std::vector<double>& second) {
  ROADBOOK_ASSERT(first.size() > 1 && second.size() > 1);
  SampleDifference difference;
  difference.second = moments_of(second);
  const double a = worth(first, moments_of(first));
  const double b = worth(second, difference.second);
  std::vector<double> x = first;
  std::vector<double> y = second;
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  for (std::size_t i = 0, j = 0; i < x.size() && j < y.size();) {
    const double at = std::min(x[i], y[j]);
    while (i < x.size() && x[i] <= at) ++i;
    while (j < y.size() && y[j] <= at) ++j;
    difference.distance = std::max(
        difference.distance, std::abs(static_cast<double>(i) / static_cast<double>(x.size()) -
                                      static_cast<double>(j) / static_cast<double>(y.size())));
  }
  difference.p = p_of(difference.distance, a * b / (a + b));
  for (int percent = 1; percent <= 99; percent += 2)
    difference.quantiles.emplace_back(quantile_of(x, 0.01 * percent),
                                      quantile_of(y, 0.01 * percent));
  return difference;
}

}  // namespace roadbook
