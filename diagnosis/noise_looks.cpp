#include "diagnosis/noise_looks.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/score_table.hpp"

namespace roadbook {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double median_share(double freedom) {
  const double a = 1.0 - 2.0 / (9.0 * freedom);
  return a * a * a;
}

NoiseCause noise_cause(
    const std::string& effect, const char* unit, double size, double sigma, double z) {
  return {effect, unit, size, sigma, z, std::erfc(std::abs(z) / std::sqrt(2.0))};
}

NoiseCause variance_by(const std::string& stream,
                       const char* name,
                       const char* unit,
                       const std::vector<ScatterLook>& looks,
                       double ScatterLook::*covariate) {
  double n = 0.0, sx = 0.0, sy = 0.0;
  for (const ScatterLook& l : looks) {
    n += 1.0;
    sx += l.*covariate;
    sy += std::log(l.square + 1e-300);
  }
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const ScatterLook& l : looks) {
    const double x = l.*covariate - sx / n;
    const double y = std::log(l.square + 1e-300) - sy / n;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const std::string effect = stream + ".variance(" + name + ")";
  // A covariate that hardly moves tells nothing.
  if (n < 50.0 || xx / n < 1e-4) return noise_cause(effect, unit, 0.0, 0.0, 0.0);
  const double slope = xy / xx;
  const double sigma = std::sqrt((yy - slope * xy) / (n - 2.0) / xx);
  return noise_cause(effect, unit, slope, sigma, slope / sigma);
}

NoiseCause outliers(const std::string& stream,
                    const std::vector<ScatterLook>& looks,
                    double readings_a_look) {
  constexpr double kChance = 1e-5;
  std::vector<double> scaled;
  for (const ScatterLook& l : looks) scaled.push_back(l.square / median_share(l.freedom));
  const double scale = scaled.empty() ? 1.0 : std::max(median(scaled), 1e-300);
  double count = 0.0;
  for (const ScatterLook& l : looks)
    if (chi_squared_tail(l.square / scale * l.freedom, static_cast<int>(l.freedom)) < kChance)
      count += 1.0;
  const auto n = static_cast<double>(looks.size());
  // Poisson tail as the equivalent normal deviate; one or two such looks name nothing.
  double tail = 1.0;
  double term = std::exp(-n * kChance);
  for (double k = 0.0; k < count; k += 1.0) {
    tail -= term;
    term *= n * kChance / (k + 1.0);
  }
  const double share = count / (n * readings_a_look);
  NoiseCause c = noise_cause(stream + ".outliers", "1", share,
                             std::sqrt(std::max(count, 1.0)) / (n * readings_a_look), 0.0);
  c.p = count < 3.0 ? 1.0 : std::max(tail, 1e-15);
  c.z = count < 3.0 ? 0.0 : std::sqrt(2.0 * count * std::log(std::max(count / (n * kChance), 1.0)));
  return c;
}

}  // namespace roadbook
