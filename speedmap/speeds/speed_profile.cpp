#include "speedmap/speeds/speed_profile.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

constexpr double kLeastForJerk = 0.05;  // [m/s]; jerk needs a speed to divide by

// b = v^2 raised no faster from place to place than acceleration and jerk allow. `most[i]`:
// acceleration from i to i + 1.
void limit_rise(std::vector<double>& b,
                const std::vector<double>& most,
                double jerk,
                double step_m) {
  double a = 0.0;  // acceleration on the step before; falling counts as 0
  bool from_rest = true;
  for (std::size_t i = 0; i + 1 < b.size(); ++i) {
    const double change = jerk * step_m / std::max(std::sqrt(b[i]), kLeastForJerk);
    // At the foot of a rise the other pass takes the other half of the change.
    const double rise = std::min(most[i], a + (from_rest ? 0.5 : 1.0) * change);
    b[i + 1] = std::min(b[i + 1], b[i] + 2.0 * step_m * rise);
    const double done = (b[i + 1] - b[i]) / (2.0 * step_m);
    from_rest = done < 0.0;
    a = std::max(0.0, done);
  }
}

// Largest function below b whose second difference is at least -bend[i]: b plus a function of just
// that second difference, taken down to its lower convex hull.
void cut_peaks(std::vector<double>& b, const std::vector<double>& bend) {
  const std::size_t n = b.size();
  std::vector<double> Q(n, 0.0);
  for (std::size_t i = 2; i < n; ++i) Q[i] = 2.0 * Q[i - 1] - Q[i - 2] + bend[i - 1];
  // Without its slope Q would be huge at the end and cost digits.
  const double slope = n > 1 ? Q[n - 1] / static_cast<double>(n - 1) : 0.0;
  for (std::size_t i = 0; i < n; ++i) Q[i] -= slope * static_cast<double>(i);
  std::vector<std::size_t> hull;
  const auto y = [&](std::size_t i) { return b[i] + Q[i]; };
  for (std::size_t i = 0; i < n; ++i) {
    while (hull.size() >= 2) {
      const std::size_t p = hull[hull.size() - 2];
      const std::size_t q = hull.back();
      const double on_line =
          y(p) + (y(i) - y(p)) * static_cast<double>(q - p) / static_cast<double>(i - p);
      if (y(q) <= on_line) break;
      hull.pop_back();
    }
    hull.push_back(i);
  }
  for (std::size_t k = 0; k + 1 < hull.size(); ++k) {
    const std::size_t p = hull[k];
    const std::size_t q = hull[k + 1];
    const double y_p = y(p);
    const double y_q = y(q);
    for (std::size_t i = p + 1; i < q; ++i)
      b[i] = y_p + (y_q - y_p) * static_cast<double>(i - p) / static_cast<double>(q - p) - Q[i];
  }
}

// The least over places within `reach` of each.
std::vector<double> lowest_within(const std::vector<double>& values, std::size_t reach) {
  std::vector<double> result(values.size());
  std::vector<std::size_t> queue;  // indices with ascending values; the front is the least
  std::size_t front = 0;
  std::size_t taken = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (; taken < values.size() && taken <= i + reach; ++taken) {
      while (queue.size() > front && values[queue.back()] >= values[taken]) queue.pop_back();
      queue.push_back(taken);
    }
    while (queue[front] + reach < i) ++front;
    result[i] = values[queue[front]];
  }
  return result;
}

struct Limits {
  std::vector<double> acceleration;  ///< on the step from i to i + 1
  std::vector<double> braking;
};

// Cutting peaks moves the change of acceleration by at most the way it takes: grip within that way
// counts.
Limits limits_of(const std::vector<double>& grip,
                 const MotionLimits& limits,
                 double top_speed,
                 double step_m) {
  const double way_m = top_speed * (limits.acceleration + limits.braking) / limits.jerk;
  const std::vector<double> low =
      lowest_within(grip, static_cast<std::size_t>(std::ceil(way_m / step_m)) + 1);
  Limits result;
  for (const double most : low) {
    result.acceleration.push_back(std::min(limits.acceleration, most));
    result.braking.push_back(std::min(limits.braking, most));
  }
  return result;
}

std::vector<double> open_way(const std::vector<double>& ceiling,
                             const std::vector<double>& grip,
                             const MotionLimits& limits,
                             double step_m) {
  const double top = *std::max_element(ceiling.begin(), ceiling.end());
  Limits most = limits_of(grip, limits, top, step_m);
  std::vector<double> forwards;
  for (const double v : ceiling) forwards.push_back(v * v);
  std::vector<double> backwards(forwards.rbegin(), forwards.rend());
  limit_rise(forwards, most.acceleration, limits.jerk, step_m);
  std::vector<double> braking(most.braking.rbegin(), most.braking.rend());
  limit_rise(backwards, braking, limits.jerk, step_m);
  std::reverse(backwards.begin(), backwards.end());
  std::vector<double> bend;
  for (std::size_t i = 0; i < forwards.size(); ++i) {
    forwards[i] = std::min(forwards[i], backwards[i]);
    bend.push_back(2.0 * limits.jerk * step_m * step_m /
                   std::max(std::sqrt(forwards[i]), kLeastForJerk));
  }
  cut_peaks(forwards, bend);
  for (double& b : forwards) b = std::sqrt(std::max(b, 0.0));
  return forwards;
}

void check(const SpeedCeiling& ceiling) {
  require_option(ceiling.step_m > 0.0 && std::isfinite(ceiling.step_m), "step_m", ceiling.step_m,
                 "above 0");
  require_option(!ceiling.speed.empty(), "speed", 0.0, "at least one place");
  for (const double v : ceiling.speed)
    require_option(std::isfinite(v) && v > 0.0, "speed", v, "a finite speed above 0");
  for (const double a : ceiling.grip_acceleration)
    require_option(a > 0.0, "grip_acceleration", a, "above 0");
  require_option(
      ceiling.grip_acceleration.empty() || ceiling.grip_acceleration.size() == ceiling.speed.size(),
      "grip_acceleration", static_cast<double>(ceiling.grip_acceleration.size()),
      "one for each place");
}

}  // namespace

void MotionLimits::check() const {
  const auto require_positive = [](double value, const char* field) {
    require_option(std::isfinite(value) && value > 0.0, field, value, "a number above 0");
  };
  require_positive(acceleration, "acceleration_mps2");
  require_positive(braking, "braking_mps2");
  require_positive(lateral, "lateral_mps2");
  require_positive(jerk, "jerk_mps3");
}

double recommended_speed(double p, double min_speed, double max_speed) {
  return max_speed + std::clamp(p, 0.0, 1.0) * (min_speed - max_speed);
}

std::vector<double> feasible_speeds(const SpeedCeiling& ceiling, const MotionLimits& limits) {
  check(ceiling);
  limits.check();
  std::vector<double> speed = ceiling.speed;
  std::vector<double> grip = ceiling.grip_acceleration;
  if (grip.empty()) grip.assign(speed.size(), INFINITY);
  if (!ceiling.closed || speed.size() < 3) return open_way(speed, grip, limits, ceiling.step_m);
  // Cut the ring open at its slowest place, which no pass changes, and close it again.
  const auto slowest = std::min_element(speed.begin(), speed.end()) - speed.begin();
  const auto turn = [&](std::vector<double>& values) {
    std::rotate(values.begin(), values.begin() + slowest, values.end());
    values.push_back(values.front());
  };
  turn(speed);
  turn(grip);
  std::vector<double> result = open_way(speed, grip, limits, ceiling.step_m);
  result.pop_back();
  std::rotate(result.begin(), result.end() - slowest, result.end());
  return result;
}

ProfileDemand demand_of(std::span<const double> speed, double step_m, bool closed) {
  ProfileDemand demand;
  const std::size_t n = speed.size();
  const auto b = [&](std::size_t i) { return speed[i % n] * speed[i % n]; };
  for (std::size_t i = 0; i + (closed ? 0 : 1) < n; ++i) {
    const double a = (b(i + 1) - b(i)) / (2.0 * step_m);
    demand.acceleration = std::max(demand.acceleration, a);
    demand.braking = std::max(demand.braking, -a);
    if (!closed && i + 2 >= n) continue;
    const double bend = (b(i + 2) - 2.0 * b(i + 1) + b(i)) / (step_m * step_m);
    demand.jerk = std::max(demand.jerk, std::abs(0.5 * speed[(i + 1) % n] * bend));
  }
  return demand;
}

}  // namespace roadbook
