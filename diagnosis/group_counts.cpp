#include "diagnosis/group_counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace roadbook {
namespace {

constexpr double kLeastScatter = 0.05;
constexpr double kMostScatter = 2.0;
constexpr double kStep = 1.15;
// What places of rendered drives scatter by in which nothing has changed (0.1 to 0.2), with room.
constexpr double kUsualScatter = 0.3;
constexpr double kDrop = 1.35;  // [nats] of the one-sided 95 % bound: 1.645^2 / 2
constexpr int kNodes = 32;      // to either side
constexpr double kReach = 8.0;  // standard deviations

double log_choose(int items, int count) {
  return std::lgamma(items + 1.0) - std::lgamma(count + 1.0) - std::lgamma(items - count + 1.0);
}

// Log odds about which those of groups lie whose mean share is `mean` (MacKay 1992, the probit
// approximation of the mean of a logistic function).
double middle_odds(double mean, double scatter) {
  return std::log(mean / (1.0 - mean)) *
         std::sqrt(1.0 + std::numbers::pi / 8.0 * scatter * scatter);
}

// Sum over the deviation of density times value(log share, log rest). The count of many items is a
// narrow peak (of width 2 / sqrt(items) in log odds), which takes closer nodes.
template <typename Value>
double over_deviation(const GroupCount& group, double scatter, const Value& value) {
  const double middle = middle_odds(group.mean, scatter);
  const double closer = std::max(1.0, scatter * std::sqrt(static_cast<double>(group.items)) / 6.0);
  const int nodes = static_cast<int>(std::ceil(kNodes * closer));
  const double spacing = kReach / nodes;
  double sum = 0.0;
  for (int node = -nodes; node <= nodes; ++node) {
    const double z = spacing * node;
    const double odds = middle + scatter * z;
    const double soft = std::log1p(std::exp(-std::abs(odds)));
    const double log_share = -soft + std::min(0.0, odds);
    const double log_rest = -soft - std::max(0.0, odds);
    sum += std::exp(-0.5 * z * z) * value(log_share, log_rest);
  }
  return sum * spacing / std::sqrt(2.0 * std::numbers::pi);
}

// Best log likelihood of all counts at this scatter, whatever share of the groups has fallen.
double profile(std::span<const GroupCount> groups,
               const std::vector<double>& fallen,
               double scatter) {
  constexpr std::array kShares{0.0, 0.01, 0.03, 0.1, 0.2, 0.3};
  std::array<double, kShares.size()> sums{};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const double standing = std::exp(group_log(groups[g], scatter));
    for (std::size_t k = 0; k < kShares.size(); ++k)
      sums[k] += std::log(std::max(1e-300, (1.0 - kShares[k]) * standing + kShares[k] * fallen[g]));
  }
  return *std::max_element(sums.begin(), sums.end());
}

}  // namespace

double group_log(const GroupCount& group, double scatter) {
  const double ways = log_choose(group.items, group.count);
  return std::log(std::max(
      1e-300, over_deviation(group, scatter, [&](double log_share, double log_rest) {
        return std::exp(ways + group.count * log_share + (group.items - group.count) * log_rest);
      })));
}

double group_tail(const GroupCount& group, double scatter) {
  std::vector<double> ways;
  for (int k = 0; k <= group.count; ++k) ways.push_back(log_choose(group.items, k));
  return std::min(1.0, over_deviation(group, scatter, [&](double log_share, double log_rest) {
                    double sum = 0.0;
                    for (int k = 0; k <= group.count; ++k)
                      sum += std::exp(ways[static_cast<std::size_t>(k)] + k * log_share +
                                      (group.items - k) * log_rest);
                    return sum;
                  }));
}

double fallen_log(const GroupCount& group) {
  constexpr int kParts = 16;
  const double ways = log_choose(group.items, group.count);
  double sum = 0.0;
  for (int k = 0; k < kParts; ++k) {
    const double share = kMostLeft * group.mean * (k + 0.5) / kParts;
    sum += std::exp(ways + group.count * std::log(share) +
                    (group.items - group.count) * std::log1p(-share));
  }
  return std::log(sum / kParts);
}

double scatter_of(std::span<const GroupCount> groups) {
  std::vector<double> fallen;
  for (const GroupCount& g : groups) fallen.push_back(std::exp(fallen_log(g)));
  std::vector<std::pair<double, double>> curve;
  double best = -1e300;
  for (double scatter = kLeastScatter; scatter < kMostScatter * kStep; scatter *= kStep) {
    const double one = std::min(scatter, kMostScatter);
    const double usual = -0.5 * std::pow(one / kUsualScatter, 2);
    curve.emplace_back(one, profile(groups, fallen, one) + usual);
    best = std::max(best, curve.back().second);
  }
  // Between the last one that stands and the next lies the bound.
  std::size_t last = 0;
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve[i].second >= best - kDrop) last = i;
  return curve[std::min(last + 1, curve.size() - 1)].first;
}

}  // namespace roadbook
