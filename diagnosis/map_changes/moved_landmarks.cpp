#include "diagnosis/map_changes/moved_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/cell_grid.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/numerics/size_interval.hpp"

namespace roadbook {
namespace {

constexpr const char* kMovedLandmarks = "map.moved_landmarks";
constexpr double kNeighbours = 2.5;   // [m] radius of neighbours that move together
constexpr double kLeastSigma = 0.02;  // [m] of a shift: rigid objects may also rotate
constexpr double kFarMoved = 5.0;     // [sigma] beyond it a landmark has moved
constexpr double kLeastFar = 0.1;     // [m]
constexpr double kSurelyMoved = 0.9;  // probability of having moved with its neighbours
constexpr std::size_t kFewestTwins = 50;
constexpr std::size_t kFewestMoved = 8;
constexpr std::size_t kFewestAlike = 3;  // landmarks of one object
constexpr double kMinGain = 10.0;        // [nats]

// A match whose shift is larger than that of an unmoved landmark.
struct FarTwin {
  LandmarkTwin twin;
  double sigma_m = 0.0;  // standard deviation of its shift
  double gate_m = 0.0;
  double gain = 0.0;  // [nats] log density ratio for having moved with its neighbours
};

// The median length of a three-dimensional normal vector is 1.538 sigma.
double scatter_of_standing(const std::vector<LandmarkTwin>& twins) {
  std::vector<double> lengths;
  for (const LandmarkTwin& t : twins)
    if (t.shift.norm() < LandmarkTwinOptions{}.static_m) lengths.push_back(t.shift.norm());
  if (lengths.empty()) return kLeastSigma;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return std::max(kLeastSigma, *middle / 1.538);
}

// For each large shift the density predicted by its neighbours (without itself) over that of a
// shift in a random direction, whose length has a power-law tail (Hill 1975).
std::vector<double> by_neighbours(const std::vector<FarTwin>& far) {
  CellGrid<std::size_t> grid(kNeighbours);
  double logs = 0.0;
  for (std::size_t i = 0; i < far.size(); ++i) {
    grid.insert(far[i].twin.then.head<2>(), i);
    logs += std::log(far[i].twin.shift.norm() / far[i].gate_m);
  }
  const double power = static_cast<double>(far.size()) / std::max(logs, 1e-9);
  const auto any_way = [&](const FarTwin& f) {
    const double r = f.twin.shift.norm();
    return power / f.gate_m * std::pow(r / f.gate_m, -power - 1.0) /
           (4.0 * std::numbers::pi * r * r);
  };
  std::vector<double> ratios(far.size(), 0.0);
  for (std::size_t i = 0; i < far.size(); ++i) {
    double sum = 0.0;
    double count = 0.0;
    grid.visit_near(far[i].twin.then.head<2>(), [&](std::size_t j) {
      if (j == i || (far[j].twin.then - far[i].twin.then).norm() > kNeighbours) return;
      const double variance = std::pow(far[i].sigma_m, 2) + std::pow(far[j].sigma_m, 2);
      sum += std::pow(2.0 * std::numbers::pi * variance, -1.5) *
             std::exp(-0.5 * (far[j].twin.shift - far[i].twin.shift).squaredNorm() / variance);
      count += 1.0;
    });
    if (count > 0.0) ratios[i] = sum / count / any_way(far[i]);
  }
  return ratios;
}

// Share of large shifts that their neighbours predict, by maximum likelihood (EM).
double predictable(const std::vector<double>& ratios) {
  double share = 0.5;
  for (int round = 0; round < 100; ++round) {
    double sum = 0.0;
    for (const double ratio : ratios) sum += share * ratio / (1.0 - share + share * ratio);
    share = std::clamp(sum / static_cast<double>(ratios.size()), 1e-6, 1.0 - 1e-6);
  }
  return share;
}

// Groups of moved landmarks, connected by neighbourhood; random ones are dropped.
std::vector<MovedThing> things_of(const std::vector<FarTwin>& moved) {
  CellGrid<std::size_t> grid(kNeighbours);
  for (std::size_t i = 0; i < moved.size(); ++i) grid.insert(moved[i].twin.then.head<2>(), i);
  std::vector<MovedThing> things;
  std::vector<std::uint8_t> taken(moved.size(), 0);
  for (std::size_t begin = 0; begin < moved.size(); ++begin) {
    if (taken[begin] != 0) continue;
    std::vector<std::size_t> chain{begin};
    taken[begin] = 1;
    for (std::size_t next = 0; next < chain.size(); ++next) {
      const FarTwin& a = moved[chain[next]];
      grid.visit_near(a.twin.then.head<2>(), [&](std::size_t j) {
        const FarTwin& b = moved[j];
        if (taken[j] != 0 || (b.twin.then - a.twin.then).norm() > kNeighbours ||
            (b.twin.shift - a.twin.shift).norm() > 4.0 * std::hypot(a.sigma_m, b.sigma_m))
          return;
        taken[j] = 1;
        chain.push_back(j);
      });
    }
    MovedThing thing;
    thing.landmarks = chain.size();
    double gain = 0.0;
    for (const std::size_t i : chain) {
      thing.then += moved[i].twin.then / static_cast<double>(chain.size());
      thing.shift += moved[i].twin.shift / static_cast<double>(chain.size());
      gain += moved[i].gain;
    }
    for (const std::size_t i : chain)
      thing.reach_m = std::max(thing.reach_m, (moved[i].twin.then - thing.then).norm());
    if (chain.size() >= kFewestAlike && gain > kMinGain) things.push_back(thing);
  }
  std::stable_sort(things.begin(), things.end(), [](const MovedThing& a, const MovedThing& b) {
    return a.landmarks > b.landmarks;
  });
  return things;
}

std::string note_of_moves(const MovedLandmarks& m) {
  std::string note = "share of the landmarks that were found again";
  char text[160];
  for (std::size_t i = 0; i < std::min<std::size_t>(3, m.things.size()); ++i) {
    const MovedThing& t = m.things[i];
    std::snprintf(
        text, sizeof text,
        "; %zu landmarks within %.1f m of x = %.1f, y = %.1f moved by (%.2f, %.2f, %.2f) m",
        t.landmarks, t.reach_m, t.then.x(), t.then.y(), t.shift.x(), t.shift.y(), t.shift.z());
    note += text;
  }
  if (m.things.size() > 3) note += "; and " + std::to_string(m.things.size() - 3) + " more";
  return note;
}

FoundCause moved_cause(const MovedLandmarks& m, double known) {
  FoundCause cause;
  cause.effect = kMovedLandmarks;
  cause.unit = "1";
  cause.size = m.share - known;
  const SizeInterval interval = interval95(kMovedLandmarks, cause.size, m.sigma);
  cause.low = interval.low;
  cause.high = interval.high;
  cause.evidence = m.gain;
  cause.p = chi_squared_tail(2.0 * m.gain, 1);
  cause.gain.total = m.gain;
  cause.gain.per_sample = m.gain / static_cast<double>(m.twins);
  cause.gain.low = m.gain - kSigmas95 * m.gain_sigma;
  cause.gain.high = m.gain + kSigmas95 * m.gain_sigma;
  cause.gain.interleaved = true;
  cause.note = note_of_moves(m);
  return cause;
}

}  // namespace

MovedLandmarks moved_landmarks(const std::vector<LandmarkTwin>& twins) {
  MovedLandmarks m;
  const double sigma = scatter_of_standing(twins);
  std::vector<FarTwin> far;
  for (const LandmarkTwin& t : twins) {
    const double own = std::hypot(sigma, t.sigma_m);
    const double gate = std::max(kLeastFar, kFarMoved * own);
    if (t.shift.norm() > gate)
      far.push_back({t, own, gate, 0.0});
    else
      ++m.twins;
  }
  if (far.empty()) return m;
  const std::vector<double> ratios = by_neighbours(far);
  const double share = predictable(ratios);
  std::vector<FarTwin> moved;
  for (std::size_t i = 0; i < far.size(); ++i) {
    const double density = 1.0 - share + share * ratios[i];
    far[i].gain = std::log(density);
    m.gain += far[i].gain;
    if (share * ratios[i] > kSurelyMoved * density) moved.push_back(far[i]);
  }
  for (const FarTwin& f : far)
    m.gain_sigma += std::pow(f.gain - m.gain / static_cast<double>(far.size()), 2);
  m.gain_sigma = std::sqrt(m.gain_sigma);
  m.things = things_of(moved);
  for (const MovedThing& t : m.things) m.moved += t.landmarks;
  m.twins += m.moved;
  if (m.twins > 0) {
    const auto n = static_cast<double>(m.twins);
    m.share = static_cast<double>(m.moved) / n;
    m.sigma = std::sqrt(m.share * (1.0 - m.share) / n);
  }
  return m;
}

Diagnosis diagnose_moved(const Map& map,
                         const std::vector<LandmarkTwin>& twins,
                         const EffectSizes& known,
                         const std::vector<std::string>& without) {
  Diagnosis d;
  if (map.sessions.size() < 2 || holds(without, kMovedLandmarks)) return d;
  d.looked_for.emplace_back(kMovedLandmarks);
  const MovedLandmarks m = moved_landmarks(twins);
  d.samples = m.twins;
  if (m.twins < kFewestTwins) {
    d.not_observable.emplace_back(kMovedLandmarks);
    d.notes.push_back(
        "moved landmarks not diagnosed, too few landmarks of other sessions were found again: " +
        std::to_string(m.twins));
    return d;
  }
  const double already = effect_size(known, "map", "moved_landmarks");
  if (m.moved < kFewestMoved || m.gain < kMinGain || m.share - already < 2.0 * m.sigma) return d;
  d.causes.push_back(moved_cause(m, already));
  d.extended[kMovedLandmarks] = d.causes.back().size;
  return d;
}

}  // namespace roadbook
