#include "speedmap/property_map/kernel.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "base/target_clones.hpp"

namespace roadbook {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kTerms = 19;

// theta (2 + cos theta) - 3 sin theta = sum over n >= 2 of (-1)^n (2 n - 2) theta^(2n+1) / (2n+1)!.
// The printed form cancels five orders near the edge and turns negative; the series does not, and
// needs neither sine nor cosine. At theta = 2 pi its largest term is 16 times the sum: two digits
// of sixteen, where the kernel is 1.
constexpr std::array<double, kTerms> series() {
  std::array<double, kTerms> c{};
  double factorial = 6.0;  // (2n+1)! for n = 1
  for (std::size_t i = 0; i < kTerms; ++i) {
    const double n = static_cast<double>(i + 2);
    factorial *= 2.0 * n * (2.0 * n + 1.0);
    c[i] = (i % 2 == 0 ? 1.0 : -1.0) * (2.0 * n - 2.0) / factorial / (3.0 * kTwoPi);
  }
  return c;
}
constexpr std::array<double, kTerms> kSeries = series();

// The multiplications and additions stand alone (no fused ones in "avx2"), so that both clones give
// the same bytes.
inline double kernel_at(double r) {
  const double theta = kTwoPi * (1.0 - r);
  const double x = theta * theta;
  double sum = kSeries[kTerms - 1];
  for (std::size_t i = kTerms - 1; i-- > 0;) sum = sum * x + kSeries[i];
  return sum * x * x * theta;
}

}  // namespace

double sparse_kernel(double r) { return r < 1.0 ? kernel_at(r) : 0.0; }

KernelDerivatives sparse_kernel_derivatives(double r) {
  if (r >= 1.0) return {};
  const double theta = kTwoPi * (1.0 - r);
  const double sine = std::sin(theta);
  const double cosine = std::cos(theta);
  KernelDerivatives d;
  d.value = kernel_at(r);
  // k''(0) and k''''(0): what the quotients tend to; the next term is of order r.
  constexpr double kSecond = -kTwoPi * kTwoPi / 3.0;
  constexpr double kFourth = kTwoPi * kTwoPi * kTwoPi * kTwoPi / 3.0;
  if (r < 1e-5) {
    d.first_over_r = kSecond + kFourth * r * r / 6.0;
    d.bend = kFourth / 3.0;
    return d;
  }
  double first = -(2.0 - 2.0 * cosine - theta * sine) / 3.0;
  double second = kTwoPi / 3.0 * (sine - theta * cosine);
  if (theta < 0.5) {
    // Series again: 2 - 2 cos - theta sin and sin - theta cos cancel four and three orders.
    const double x = theta * theta;
    const double edge = x * x / 36.0;
    first = -edge *
            (1.0 - x / 15.0 *
                       (1.0 - 3.0 * x / 112.0 * (1.0 - 2.0 * x / 135.0 * (1.0 - 5.0 * x / 528.0))));
    second = kTwoPi / 9.0 * theta * x *
             (1.0 - x / 10.0 * (1.0 - x / 28.0 * (1.0 - x / 54.0 * (1.0 - x / 88.0))));
  }
  d.first_over_r = first / r;
  d.bend = (second - d.first_over_r) / (r * r);
  return d;
}

ROADBOOK_CLONES __attribute__((optimize("O3"))) void sparse_kernel_of_squares(const double* r2,
                                                                              double* k,
                                                                              std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) k[i] = kernel_at(std::sqrt(r2[i]));
}

}  // namespace roadbook
