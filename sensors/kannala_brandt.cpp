#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sensors/camera_projections.hpp"

namespace roadbook {
namespace {

constexpr int kAngleIterations = 30;
// A slope polynomial that comes this near to 0 without crossing it does not occur with lenses.
constexpr int kMaxHalvings = 30;

// Whether a quartic with Bernstein coefficients b on [0, 1] is positive there: it is if all of them
// are, it is not if one of its ends is not, and else its two halves (de Casteljau) tell.
bool positive(std::array<double, 5> b, int halvings) {
  if (!(b[0] > 0.0) || !(b[4] > 0.0)) return false;
  if (b[1] > 0.0 && b[2] > 0.0 && b[3] > 0.0) return true;
  if (halvings == 0) return false;
  std::array<double, 5> left;
  for (std::size_t i = 0; i < 5; ++i) {
    left[i] = b[0];
    for (std::size_t j = 0; j + i < 4; ++j) b[j] = 0.5 * (b[j] + b[j + 1]);
  }
  return positive(left, halvings - 1) && positive(b, halvings - 1);
}

// Last angle up to `max_angle` at which the radius still grows.
double kb_last_angle(const double* k, double max_angle) {
  if (kannala_brandt_grows(k, max_angle)) return max_angle;
  double inside = 0.0;
  double outside = max_angle;
  while (outside - inside > 1e-15) {
    const double middle = 0.5 * (inside + outside);
    if (middle <= inside || middle >= outside) break;
    (kannala_brandt_grows(k, middle) ? inside : outside) = middle;
  }
  return inside;
}

bool kb_solves(const double* k, double theta, double radius) {
  return std::abs(kannala_brandt_radius(k, theta) - radius) < 1e-12 * (1.0 + radius);
}

// Newton within [0, end], where the radius grows: the bracket shrinks in every step and is halved
// where Newton leaves it, so an existing solution is always found.
std::optional<double> kb_angle_within(const double* k, double radius, double end) {
  double below = 0.0;
  double above = end;
  double theta = std::min(radius, end);
  for (int i = 0; i < 2 * kAngleIterations; ++i) {
    const double error = kannala_brandt_radius(k, theta) - radius;
    (error > 0.0 ? above : below) = theta;
    const double slope = kannala_brandt_slope(k, theta);
    double next = theta - error / slope;
    if (!(slope > 0.0) || !(next > below && next < above)) next = 0.5 * (below + above);
    if (next == theta || error == 0.0) break;
    theta = next;
  }
  return kb_solves(k, theta, radius) ? std::optional(theta) : std::nullopt;
}

}  // namespace

double kannala_brandt_radius(const double* k, double theta) {
  const double t2 = theta * theta;
  return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}
double kannala_brandt_slope(const double* k, double theta) {
  const double t2 = theta * theta;
  return 1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
}

bool kannala_brandt_grows(const double* k, double theta) {
  if (!(theta >= 0.0)) return false;
  // dr/dtheta = 1 + 3 k1 t + 5 k2 t^2 + 7 k3 t^3 + 9 k4 t^4 with t = theta^2.
  const double t = theta * theta;
  const double a1 = 3.0 * k[0] * t;
  const double a2 = 5.0 * k[1] * t * t;
  const double a3 = 7.0 * k[2] * t * t * t;
  const double a4 = 9.0 * k[3] * t * t * t * t;
  // Without its positive terms the slope is smallest at the end: this settles most rays.
  if (1.0 + std::fmin(a1, 0.0) + std::fmin(a2, 0.0) + std::fmin(a3, 0.0) + std::fmin(a4, 0.0) > 0.0)
    return true;
  return positive({1.0, 1.0 + a1 / 4.0, 1.0 + a1 / 2.0 + a2 / 6.0,
                   1.0 + 0.75 * a1 + 0.5 * a2 + 0.25 * a3, 1.0 + a1 + a2 + a3 + a4},
                  kMaxHalvings);
}

// Plain Newton nearly always ends at the angle; whether it is the one on the growing branch is
// quickly checked. Only else the end of that branch is looked for.
std::optional<double> kannala_brandt_angle(const double* k, double radius, double max_angle) {
  double theta = std::min(radius, max_angle);
  for (int i = 0; i < kAngleIterations; ++i) {
    const double slope = kannala_brandt_slope(k, theta);
    if (!(slope > 1e-6)) break;
    const double step = (kannala_brandt_radius(k, theta) - radius) / slope;
    theta = std::clamp(theta - step, 0.0, max_angle);
    if (std::abs(step) < 1e-15) break;
  }
  if (kb_solves(k, theta, radius) && kannala_brandt_grows(k, theta)) return theta;
  return kb_angle_within(k, radius, kb_last_angle(k, max_angle));
}

}  // namespace roadbook
