#include "vo/ground_scale.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {

std::optional<GroundScale> ground_scale(std::vector<double> height_ratios, int min_support) {
  std::erase_if(height_ratios, [](double r) { return !(r > 0.02 && r < 50.0); });
  for (double& ratio : height_ratios) ratio = std::log(ratio);
  std::sort(height_ratios.begin(), height_ratios.end());
  constexpr double kHalfWidth = 0.06;  // 6 %: slopes, kerbs and triangulation noise
  const auto count_in = [&](double low, double high) {
    return std::upper_bound(height_ratios.begin(), height_ratios.end(), high) -
           std::lower_bound(height_ratios.begin(), height_ratios.end(), low);
  };
  double best = 0.0;
  std::ptrdiff_t support = 0;
  for (const double centre : height_ratios) {
    const auto count = count_in(centre - kHalfWidth, centre + kHalfWidth);
    if (count > support) {
      support = count;
      best = centre;
    }
  }
  if (support < min_support) return std::nullopt;
  double mean = best;
  double variance = 0.0;
  for (int iteration = 0; iteration < 5; ++iteration) {
    const auto first =
        std::lower_bound(height_ratios.begin(), height_ratios.end(), mean - kHalfWidth);
    const auto last = std::upper_bound(first, height_ratios.end(), mean + kHalfWidth);
    const auto count = static_cast<double>(last - first);
    if (count < 1.0) break;
    double sum = 0.0;
    double squares = 0.0;
    for (auto it = first; it != last; ++it) {
      sum += *it;
      squares += *it * *it;
    }
    mean = sum / count;
    variance = std::max(0.0, squares / count - mean * mean) / count;
    support = last - first;
  }
  return GroundScale{std::exp(mean), std::sqrt(variance), static_cast<int>(support)};
}

}  // namespace roadbook
