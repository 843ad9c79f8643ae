#include "diagnosis/numerics/group_counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace roadbook {
namespace {

constexpr double kLeastScatter = 0.05;
constexpr double kMostScatter = 2.0;
constexpr double kScatterStep = 1.15;
// What places of rendered drives scatter by in which nothing has changed (0.1 to 0.2), with room.
constexpr double kUsualScatter = 0.3;
constexpr double kDrop = 1.35;     // [nats] of the one-sided 95 % bound: 1.645^2 / 2
constexpr double kRounding = 0.1;  // of log odds: items that differ by less are treated as equal
constexpr double kFinestDeviation =
    0.2;  // deviations at which integrals are taken: kFinestDeviation sinh(u)
constexpr double kNodeSpacing = 0.1;  // of u; 0.02 of the deviation about 0, a tenth of it far off
constexpr int kNodes = 50;            // to either side: as far as 15
constexpr std::size_t kAll = 2 * kNodes + 1;

using Curve = std::array<double, kAll>;  // at the nodes

struct Nodes {
  Curve deviation{};
  Curve width{};  // width of the interval of each value
  Nodes() {
    for (std::size_t node = 0; node < kAll; ++node) {
      const double u = kNodeSpacing * (static_cast<double>(node) - kNodes);
      deviation[node] = kFinestDeviation * std::sinh(u);
      width[node] = kFinestDeviation * std::cosh(u) * kNodeSpacing;
    }
  }
};

const Nodes& nodes() {
  static const Nodes kTable;
  return kTable;
}

double softplus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

// Items of nearly equal log odds, with their mean.
struct Alike {
  int items = 0;
  double odds = 0.0;
};

std::vector<Alike> alike_items(const GroupCount& group) {
  std::map<long, Alike> bins;
  for (const double c : group.chances) {
    const double odds = std::log(c / (1.0 - c));
    Alike& bin = bins[std::lround(odds / kRounding)];
    bin.odds += (odds - bin.odds) / ++bin.items;
  }
  std::vector<Alike> all;
  for (const auto& [place, bin] : bins) all.push_back(bin);
  return all;
}

// log probabilities of 0 ... count where nothing deviates. Products of many small chances: long
// double, whose exponents reach down to -4900.
std::vector<double> log_counts(const std::vector<Alike>& items, int count) {
  std::vector<long double> p(static_cast<std::size_t>(count) + 1, 0.0L);
  p[0] = 1.0L;
  for (const Alike& bin : items) {
    const long double chance = 1.0 / (1.0 + std::exp(-bin.odds));
    for (int i = 0; i < bin.items; ++i) {
      for (std::size_t k = p.size() - 1; k > 0; --k)
        p[k] = p[k] * (1.0L - chance) + p[k - 1] * chance;
      p[0] *= 1.0L - chance;
    }
  }
  std::vector<double> logs;
  for (const long double one : p)
    logs.push_back(one > 0.0L ? static_cast<double>(std::log(one)) : -1e9);
  return logs;
}

// Probability of the group's count, or of that and fewer, by what the group deviates. A deviation d
// of all log odds o multiplies that of k by exp(k d) and divides all by the same:
// prod (1 + exp(o + d)) / (1 + exp(o)).
Curve count_curve(const GroupCount& group, bool or_fewer) {
  const std::vector<Alike> items = alike_items(group);
  const std::vector<double> logs = log_counts(items, group.count);
  Curve curve{};
  for (std::size_t node = 0; node < kAll; ++node) {
    const double d = nodes().deviation[node];
    double all = 0.0;
    for (const Alike& bin : items) all += bin.items * (softplus(bin.odds + d) - softplus(bin.odds));
    for (std::size_t k = or_fewer ? 0 : logs.size() - 1; k < logs.size(); ++k)
      curve[node] += std::exp(logs[k] + static_cast<double>(k) * d - all);
  }
  return curve;
}

// By how much the middle of a group's log odds lies off so that its mean share is what its items'
// chances say (MacKay 1992, the probit approximation of the mean of a logistic function).
double middle_shift(const GroupCount& group, double scatter) {
  const double mean = group.expected() / static_cast<double>(group.chances.size());
  return std::log(mean / (1.0 - mean)) *
         (std::sqrt(1.0 + std::numbers::pi / 8.0 * scatter * scatter) - 1.0);
}

double integral(const Curve& curve, double middle, double scatter) {
  if (scatter < kLeastScatter) return curve[kNodes];
  const auto& [deviation, width] = nodes();
  double sum = 0.0;
  for (std::size_t node = 0; node < kAll; ++node) {
    const double z = (deviation[node] - middle) / scatter;
    if (std::abs(z) < 8.5) sum += width[node] * std::exp(-0.5 * z * z) * curve[node];
  }
  return sum / (scatter * std::sqrt(2.0 * std::numbers::pi));
}

struct Judged {
  const GroupCount* group;
  Curve curve;
  double fallen;
};

// Best log likelihood of all counts at this scatter, whatever share of the groups has fallen.
double profile(const std::vector<Judged>& groups, double scatter) {
  constexpr std::array kShares{0.0, 0.01, 0.03, 0.1, 0.2, 0.3};
  std::array<double, kShares.size()> sums{};
  for (const Judged& g : groups) {
    const double standing = integral(g.curve, middle_shift(*g.group, scatter), scatter);
    for (std::size_t k = 0; k < kShares.size(); ++k)
      sums[k] += std::log(std::max(1e-300, (1.0 - kShares[k]) * standing + kShares[k] * g.fallen));
  }
  return *std::max_element(sums.begin(), sums.end());
}

}  // namespace

double GroupCount::expected() const { return std::accumulate(chances.begin(), chances.end(), 0.0); }

double group_log(const GroupCount& group, double scatter) {
  return std::log(
      std::max(1e-300, integral(count_curve(group, false), middle_shift(group, scatter), scatter)));
}

double group_tail(const GroupCount& group, double scatter) {
  return std::min(1.0, integral(count_curve(group, true), middle_shift(group, scatter), scatter));
}

double fallen_log(const GroupCount& group) {
  constexpr int kParts = 16;
  const auto items = static_cast<double>(group.chances.size());
  const double mean = group.expected() / items;
  const double rest = items - group.count;
  const double ways =
      std::lgamma(items + 1.0) - std::lgamma(group.count + 1.0) - std::lgamma(rest + 1.0);
  double sum = 0.0;
  for (int k = 0; k < kParts; ++k) {
    const double share = kMostLeft * mean * (k + 0.5) / kParts;
    sum += std::exp(ways + group.count * std::log(share) + rest * std::log1p(-share));
  }
  return std::log(sum / kParts);
}

double scatter_of(std::span<const GroupCount> groups) {
  std::vector<Judged> judged;
  for (const GroupCount& g : groups)
    judged.push_back({&g, count_curve(g, false), std::exp(fallen_log(g))});
  std::vector<std::pair<double, double>> curve;
  double best = -1e300;
  for (double scatter = kLeastScatter; scatter < kMostScatter * kScatterStep;
       scatter *= kScatterStep) {
    const double one = std::min(scatter, kMostScatter);
    const double usual = -0.5 * std::pow(one / kUsualScatter, 2);
    curve.emplace_back(one, profile(judged, one) + usual);
    best = std::max(best, curve.back().second);
  }
  // The bound lies between the last accepted value and the next.
  std::size_t last = 0;
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve[i].second >= best - kDrop) last = i;
  return curve[std::min(last + 1, curve.size() - 1)].first;
}

}  // namespace roadbook
