#include "diagnosis/motion/motion_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/numerics/probes.hpp"

namespace roadbook {
namespace {

// Sum of squares and redundancy of one kind of noise.
struct Spread {
  double squares = 0.0;
  double redundancy = 0.0;
  // Few redundant rows tell little: the old value counts as ten of them.
  [[nodiscard]] double factor() const {
    constexpr double kBefore = 10.0;
    const double ratio = (squares + kBefore) / (std::max(redundancy, 0.0) + kBefore);
    return std::clamp(std::sqrt(ratio), 0.05, 20.0);
  }
};

// Fisher scoring for the variance of one channel: an innovation's variance is V times that of its
// row, so (e^2 - 1) / V is its share of the score.
struct Scoring {
  double score = 0.0;
  double information = 0.0;
  double rows = 0.0;
  void add(double e, double variance) {
    score += (e * e - 1.0) / variance;
    information += 1.0 / (variance * variance);
    rows += 1.0;
  }
  [[nodiscard]] double factor(double fitted) const {
    constexpr double kBefore = 10.0;
    if (rows == 0.0) return 1.0;
    // Each fitted parameter has taken one square.
    const double step = (score + fitted * information / rows) / (information + kBefore);
    return std::clamp(std::sqrt(std::max(1.0 + step, 0.05)), 0.3, 20.0);
  }
};

std::vector<double> unit_weights(std::size_t sides, std::size_t which) {
  std::vector<double> weights(sides, 0.0);
  weights[which] = 1.0;
  return weights;
}

}  // namespace

void apply_solution(const Elimination::Solution& solution, Trajectory& trajectory) {
  const std::size_t intervals = solution.knots.size();
  ROADBOOK_ASSERT(intervals + 1 == trajectory.knots());
  for (std::size_t j = 0; j < intervals; ++j) {
    const auto& change = solution.knots[intervals - 1 - j];
    trajectory.x[j] += change[kX];
    trajectory.y[j] += change[kY];
    trajectory.heading[j] += change[kHeading];
    trajectory.speed[j] += change[kSpeedA];
    trajectory.yaw_rate[j] += change[kYawA];
  }
  const auto& last = solution.knots.front();
  trajectory.speed.back() += last[kSpeedB];
  trajectory.yaw_rate.back() += last[kYawB];
  // No reading follows the last knot: its pose continues from the interval before.
  const MotionState end = trajectory.after(intervals - 1, trajectory.step_s());
  trajectory.x.back() = end.x;
  trajectory.y.back() = end.y;
  trajectory.heading.back() = end.heading;
  trajectory.integrate();
}

MotionNoise renewed_noise(const MotionNoise& noise,
                          const Pass& pass,
                          const std::vector<double>& weights,
                          std::size_t probes,
                          const std::array<double, kChannels>& fitted) {
  std::array<Scoring, kChannels> read{};
  const Innovations& in = pass.innovations;
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    double e = 0.0;
    for (std::size_t k = 0; k < in.sides; ++k) e += weights[k] * in.row(i)[k];
    read[in.of[i].channel].add(e, in.of[i].variance);
  }
  const auto factor = [&](Channel c) { return read[index_of(c)].factor(fitted[index_of(c)]); };

  Spread speed, yaw, distance, heading, angle;
  const auto solution = pass.elimination.back_substitute(weights);
  const auto share = 1.0 / static_cast<double>(probes);
  for (const auto& r : solution.knot_residuals) {
    speed.squares += r[1] * r[1];
    yaw.squares += r[2] * r[2];
  }
  for (const auto& r : solution.walk_residuals) {
    distance.squares += r[0] * r[0];
    heading.squares += r[1] * r[1];
  }
  for (const auto& r : solution.readings) angle.squares += r[0] * r[0] + r[1] * r[1];
  for (std::size_t k = 0; k < probes; ++k) {
    const auto probe =
        pass.elimination.back_substitute(unit_weights(in.sides, in.sides - probes + k));
    for (std::size_t i = 0; i < probe.knot_residuals.size(); ++i) {
      const auto& r = probe.knot_residuals[i];
      const auto& n = probe.knot_sides[i];
      speed.redundancy -= share * r[1] * n[1];
      yaw.redundancy -= share * r[2] * n[2];
    }
    for (std::size_t i = 0; i < probe.walk_residuals.size(); ++i) {
      distance.redundancy -= share * probe.walk_residuals[i][0] * probe.walk_sides[i][0];
      heading.redundancy -= share * probe.walk_residuals[i][1] * probe.walk_sides[i][1];
    }
    const std::size_t wheels = probe.readings.size();
    for (std::size_t i = 0; i < wheels; ++i)
      for (std::size_t d = 0; d < pass.wheel_channels; ++d) {
        const double n = probe_sign(Probe::kReading, 2 * (wheels - i) + d, k);
        angle.redundancy -= share * (probe.readings[i][d] - n) * n;
      }
  }
  MotionNoise next = noise;
  next.steering_rad *= factor(Channel::kSteering);
  next.gyro_rad_s = std::max(noise.gyro_rad_s * factor(Channel::kGyro), noise.least_gyro_rad_s);
  next.pose[0] *= factor(Channel::kPoseAlong);
  next.pose[1] *= factor(Channel::kPoseAcross);
  next.pose[2] *= factor(Channel::kPoseHeading);
  next.pose[0] = std::max(next.pose[0], MotionNoise::kLeastPosition);
  next.pose[1] = std::max(next.pose[1], MotionNoise::kLeastPosition);
  next.pose[2] = std::max(next.pose[2], MotionNoise::kLeastHeading);
  next.speed_m_s *= speed.factor();
  next.yaw_rad_s *= yaw.factor();
  next.distance_per_sqrt_m *= distance.factor();
  next.heading_per_sqrt_m *= heading.factor();
  next.wheel_angle_rad *= angle.factor();
  return next;
}

}  // namespace roadbook
