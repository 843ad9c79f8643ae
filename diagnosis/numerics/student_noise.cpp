#include "diagnosis/numerics/student_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/median.hpp"

namespace roadbook {
namespace {

constexpr std::array<double, 7> kFreedoms{2.0, 3.0, 4.0, 6.0, 10.0, 20.0, 50.0};
constexpr double kWorthTails = 5.0;  // [nats] by which tails have to be more likely than none

// Scale of the most likely distribution with these degrees of freedom, by expectation maximisation.
double likely_variance(const std::vector<double>& squares, double freedom, double start) {
  double variance = start;
  for (int round = 0; round < 30; ++round) {
    double sum = 0.0;
    for (const double q : squares) sum += q * student_weight(q / variance, freedom);
    const double next = std::max(1e-12, 0.5 * sum / static_cast<double>(squares.size()));
    const bool done = std::abs(next - variance) < 1e-4 * variance;
    variance = next;
    if (done) break;
  }
  return variance;
}

// In two dimensions the density is (1 + q / (v s^2))^-(v + 2)/2 / (2 pi s^2).
double log_likelihood(const std::vector<double>& squares, double freedom, double variance) {
  double sum = 0.0;
  for (const double q : squares)
    sum -= freedom >= kNormalFreedom ? 0.5 * q / variance
                                     : 0.5 * (freedom + 2.0) * std::log1p(q / (freedom * variance));
  return sum - static_cast<double>(squares.size()) * std::log(variance);
}

}  // namespace

double student_weight(double square, double freedom) {
  return freedom >= kNormalFreedom ? 1.0 : (freedom + 2.0) / (freedom + square);
}

double view_gate(double freedom) {
  constexpr double kNormal = 4.0;
  constexpr double kMost = 8.0;
  if (freedom >= kNormalFreedom) return kNormal;
  return std::min(kMost, std::sqrt(freedom * std::expm1(kNormal * kNormal / freedom)));
}

double student_excess(double freedom) { return (freedom + 4.0) / (freedom + 2.0); }

StudentNoise student_noise(const std::vector<double>& squares) {
  const double start = std::max(1e-12, median(squares) / kMedianOfTwoSquares);
  StudentNoise best;
  double variance = likely_variance(squares, kNormalFreedom, start);
  best.sigma = std::sqrt(variance);
  double most = log_likelihood(squares, kNormalFreedom, variance) + kWorthTails;
  for (const double freedom : kFreedoms) {
    variance = likely_variance(squares, freedom, start);
    if (const double l = log_likelihood(squares, freedom, variance); l > most) {
      most = l;
      best = {std::sqrt(variance), freedom};
    }
  }
  return best;
}

}  // namespace roadbook
