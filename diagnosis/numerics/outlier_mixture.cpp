#include "diagnosis/numerics/outlier_mixture.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

OutlierMixture fit_outliers(const std::vector<double>& z) {
  constexpr double kFactor = 10.0;
  const auto n = static_cast<double>(z.size());
  double squares = 0.0;
  for (const double v : z) squares += v * v;
  OutlierMixture m;
  m.alone = std::sqrt(squares / n);
  m.part.assign(z.size(), 0.0);
  m.share = 0.02;
  m.scale = 0.9 * m.alone;
  double log_likelihood = 0.0;
  double information = 0.0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    double sum = 0.0;
    double weighted = 0.0;
    log_likelihood = information = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double u = 0.5 * z[i] * z[i] / (m.scale * m.scale);
      const double core = std::exp(-u);
      const double wide = std::exp(-u / (kFactor * kFactor)) / kFactor;
      const double both = (1.0 - m.share) * core + m.share * wide;
      m.part[i] = both > 0.0 ? m.share * wide / both : 1.0;
      sum += m.part[i];
      weighted += z[i] * z[i] * (1.0 - m.part[i] + m.part[i] / (kFactor * kFactor));
      log_likelihood += std::log(std::max(both, 1e-300)) - std::log(m.scale);
      const double slope = both > 0.0 ? (wide - core) / both : 1.0 / m.share;
      information += slope * slope;
    }
    m.share = std::max(sum / n, 1e-9);
    m.scale = std::sqrt(weighted / n);
  }
  m.gained = log_likelihood - (-0.5 * n - n * std::log(m.alone));
  m.share_sigma = 1.0 / std::sqrt(information);
  return m;
}

}  // namespace roadbook
