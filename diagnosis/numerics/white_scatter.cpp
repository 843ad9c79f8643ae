#include "diagnosis/numerics/white_scatter.hpp"

#include <cmath>
#include <utility>

#include "base/median.hpp"

namespace roadbook {

double white_scatter(const std::vector<double>& values) {
  constexpr double kOfThird = 20.0;          // variance of a third difference, 1 + 9 + 9 + 1
  constexpr double kMedianToSigma = 1.4826;  // of the size of a normal deviate
  std::vector<double> sizes;
  for (std::size_t i = 3; i < values.size(); ++i)
    sizes.push_back(std::abs(values[i] - values[i - 3] - 3.0 * (values[i - 1] - values[i - 2])));
  return sizes.empty() ? 0.0 : kMedianToSigma * median(std::move(sizes)) / std::sqrt(kOfThird);
}

}  // namespace roadbook
