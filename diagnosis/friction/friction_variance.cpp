#include "diagnosis/friction/friction_variance.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/inference/score_table.hpp"

namespace roadbook {
namespace {

constexpr double kVarianceTests = 5.0;  // number of noise effects tested
constexpr double kMaxVarianceP = 1e-4;  // corrected

double corrected_p(double z) { return std::min(1.0, kVarianceTests * chi_squared_tail(z * z, 1)); }

// Maximum likelihood of log variance = size * (x - mean of x), with a test that is valid for heavy
// tails.
NoiseCause variance_slope(const std::vector<double>& e, const std::vector<double>& x) {
  const auto n = static_cast<double>(e.size());
  double mean_x = 0.0, mean_square = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    mean_x += x[i] / n;
    mean_square += e[i] * e[i] / n;
  }
  NoiseCause cause;
  double score = 0.0, scatter = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const double u = (e[i] * e[i] / mean_square - 1.0) * (x[i] - mean_x);
    score += u;
    scatter += u * u;
    spread += (x[i] - mean_x) * (x[i] - mean_x);
  }
  if (!(spread > 1e-9 * n) || !(scatter > 0.0)) return cause;
  cause.z = score / std::sqrt(scatter);
  double level = std::log(mean_square);
  for (int iteration = 0; iteration < 30; ++iteration) {
    double step = 0.0, total = 0.0;
    for (std::size_t i = 0; i < e.size(); ++i) {
      const double left = e[i] * e[i] * std::exp(-level - cause.size * (x[i] - mean_x)) - 1.0;
      step += left * (x[i] - mean_x) / spread;
      total += left / n;
    }
    cause.size += std::clamp(0.7 * step, -1.0, 1.0);
    level += std::clamp(total, -1.0, 1.0);
  }
  cause.sigma = std::sqrt(2.0 / spread);
  cause.p = corrected_p(cause.z);
  return cause;
}

}  // namespace

std::vector<NoiseCause> noise_parts(const FrictionNoise& noise) {
  std::vector<NoiseCause> causes;
  const auto add = [&](const char* effect, double size, double sigma, double z) {
    causes.push_back({effect, "1", size, sigma, z, corrected_p(z)});
  };
  if (noise.place_sd > 0.0)
    add("friction0.spatial_bias", noise.place_sd, noise.place_sigma, noise.place_z);
  if (noise.outliers > 0.0)
    add("friction0.outliers", noise.outliers, noise.outliers_sigma, noise.outliers_z);
  if (noise.correlation != 0.0)
    add("friction0.correlation", noise.correlation, noise.correlation_sigma,
        noise.correlation / noise.correlation_sigma);
  return causes;
}

std::vector<NoiseCause> variance_causes(const std::vector<FrictionSample>& samples,
                                        const Innovations& innovations) {
  std::vector<double> e, speed, turn;
  for (std::size_t i = 0; i < innovations.of.size(); ++i) {
    if (innovations.of[i].variance > 2.0) continue;  // the first readings of a class
    const FrictionSample& s = samples[innovations.of[i].row];
    e.push_back(innovations.row(i)[0]);
    speed.push_back(s.speed);
    turn.push_back(std::abs(s.yaw_rate));
  }
  if (e.size() < 100) return {};
  NoiseCause by_speed = variance_slope(e, speed);
  by_speed.effect = "friction0.variance(speed)";
  by_speed.unit = "s/m";
  NoiseCause by_turn = variance_slope(e, turn);
  by_turn.effect = "friction0.variance(turn)";
  by_turn.unit = "s/rad";
  // Speed and turn rate are correlated: the weaker is tested with the stronger in the model.
  const bool speed_first = std::abs(by_speed.z) >= std::abs(by_turn.z);
  NoiseCause& first = speed_first ? by_speed : by_turn;
  if (first.p > kMaxVarianceP) return {};
  const std::vector<double>& x = speed_first ? speed : turn;
  for (std::size_t i = 0; i < e.size(); ++i) e[i] *= std::exp(-0.5 * first.size * x[i]);
  NoiseCause second = variance_slope(e, speed_first ? turn : speed);
  second.effect = speed_first ? by_turn.effect : by_speed.effect;
  second.unit = speed_first ? by_turn.unit : by_speed.unit;
  std::vector<NoiseCause> causes{first};
  if (second.p <= kMaxVarianceP) causes.push_back(second);
  return causes;
}

}  // namespace roadbook
