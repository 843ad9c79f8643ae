#include "diagnosis/student_tail.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {

double student_tail(double t, int freedom) {
  ROADBOOK_ASSERT(freedom > 0 && freedom % 2 == 1);
  if (std::isnan(t)) return 1.0;
  // Abramowitz and Stegun 26.7.3.
  const double angle = std::atan(t / std::sqrt(freedom));
  const double cosine = std::cos(angle);
  double term = std::sin(angle) * cosine;
  double inside = angle;
  for (int k = 1; k < freedom; k += 2) {
    inside += term;
    term *= cosine * cosine * (k + 1.0) / (k + 2.0);
  }
  constexpr double kDigits = 1e-15;
  return std::max(kDigits, 0.5 - inside / M_PI);
}

}  // namespace roadbook
