#include "diagnosis/givens.hpp"

#include <cmath>

namespace roadbook {
namespace {

// Most of diagnosis' time is spent in this loop. No fused multiply-add: the same bits on every
// processor.
__attribute__((target_clones("avx2", "default"), optimize("O3"))) void apply(
    double* __restrict a, double* __restrict b, std::size_t n, double c, double s) {
  for (std::size_t i = 0; i < n; ++i) {
    const double u = a[i];
    const double v = b[i];
    a[i] = c * u + s * v;
    b[i] = c * v - s * u;
  }
}

}  // namespace

double rotate_rows(double* a, double* b, std::size_t from, std::size_t to) {
  const double y = b[from];
  if (y == 0.0) return 1.0;
  const double x = a[from];
  const double length = std::sqrt(x * x + y * y);
  const double c = x / length;
  apply(a + from, b + from, to - from, c, y / length);
  b[from] = 0.0;
  return c;
}

}  // namespace roadbook
