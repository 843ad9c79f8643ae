#include "diagnosis/friction/friction_places.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

constexpr const char* kExtraClass = "friction0.extra_class";
constexpr double kRadii[] = {5.0, 8.0, 13.0, 20.0, 32.0, 50.0};  // [m]

// Chi-squared of the difference between inside and outside, from the sums and numbers of residuals
// inside and of the whole class.
double statistic(double sum, double inside, double class_sum, double count) {
  if (inside < 3.0 || count - inside < 3.0) return 0.0;
  const double u = sum - inside / count * class_sum;
  return u * u / (inside * (1.0 - inside / count));
}

// Readings of one class in contiguous arrays: discs are evaluated thousands of times.
struct ClassReadings {
  std::vector<double> x, y, residual;
  double sum = 0.0;

  [[nodiscard]] double statistic_of(const Candidate& c) const {
    double inside_sum = 0.0, inside = 0.0;
    const double square = c.place_radius * c.place_radius;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double dx = x[i] - c.place_x;
      const double dy = y[i] - c.place_y;
      const double in = dx * dx + dy * dy < square ? 1.0 : 0.0;
      inside += in;
      inside_sum += in * residual[i];
    }
    return statistic(inside_sum, inside, sum, static_cast<double>(x.size()));
  }
};

ClassReadings readings_of(const FrictionReadings& readings,
                          const SurfaceClasses& classes,
                          const Eigen::VectorXd& residuals,
                          std::size_t k) {
  ClassReadings own;
  for (std::size_t i = 0; i < readings.samples.size(); ++i) {
    if (classes.of[i] != k) continue;
    own.x.push_back(readings.samples[i].x);
    own.y.push_back(readings.samples[i].y);
    own.residual.push_back(residuals[static_cast<Eigen::Index>(i)]);
    own.sum += own.residual.back();
  }
  return own;
}

// A disc with its chi-squared.
using Scored = std::pair<double, Candidate>;

// Neighbours in the pattern search: steps of the centre and of the radius; and steps of the centre
// along some direction with the radius such that both ends of the perpendicular chord stay in
// place. A road enters and leaves a disc at two points that are known to a decimetre; other steps
// would move those points.
std::vector<Candidate> neighbours(const Candidate& centre, double step, int round) {
  std::vector<Candidate> discs;
  const double r = centre.place_radius;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        Candidate c = centre;
        c.place_x += step * r * i;
        c.place_y += step * r * j;
        c.place_radius *= 1.0 + step * k;
        discs.push_back(c);
      }
  constexpr int kDirections = 16;
  constexpr double kTurn = 0.13;  // [rad] rotation of the directions between rounds
  for (int i = 0; i < kDirections; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kDirections + kTurn * round;
    for (const double chord : {-0.9, -0.5, 0.0, 0.5, 0.9}) {
      Candidate c = centre;
      c.place_x += step * r * std::cos(a);
      c.place_y += step * r * std::sin(a);
      c.place_radius = r * std::sqrt(1.0 - chord * chord + (chord + step) * (chord + step));
      discs.push_back(c);
    }
  }
  return discs;
}

// Pattern search for the largest chi-squared. A successful step is repeated, so that edges that are
// metres off are reached.
Scored moved(const ClassReadings& own, Candidate place, double step = 0.3) {
  constexpr int kMostRounds = 60;
  constexpr double kFinestStep = 0.003;  // relative to the radius
  double best = own.statistic_of(place);
  for (int round = 0; round < kMostRounds && step > kFinestStep; ++round) {
    const double before = best;
    for (const Candidate& c : neighbours(place, step, round))
      if (const double t = own.statistic_of(c); t > best) {
        best = t;
        place = c;
      }
    if (!(best > before)) step *= 0.6;
  }
  return {best, place};
}

double plausible_size() {
  for (const EffectInfo& e : reading_effects())
    if (e.name == kExtraClass) return e.plausible;
  return 0.2;
}

// For each radius the best disc of class k about a visited cell, from sums over cells; most
// significant first.
std::vector<Scored> coarse_discs(const ClassReadings& own,
                                 const std::vector<std::size_t>& cell_of,
                                 const PlaceCells& cells,
                                 std::size_t k) {
  const std::size_t m = cells.centres.size();
  std::vector<double> sums(m, 0.0), counts(m, 0.0);
  for (std::size_t i = 0; i < cell_of.size(); ++i) {
    sums[cell_of[i]] += own.residual[i];
    counts[cell_of[i]] += 1.0;
  }
  std::vector<Scored> discs;
  for (const double radius : kRadii) {
    Scored top{0.0, {}};
    for (std::size_t c = 0; c < m; ++c) {
      double sum = 0.0, inside = 0.0;
      for (std::size_t d = 0; d < m; ++d)
        if ((cells.centres[d] - cells.centres[c]).squaredNorm() < radius * radius) {
          sum += sums[d];
          inside += counts[d];
        }
      const double t = statistic(sum, inside, own.sum, static_cast<double>(own.x.size()));
      if (t <= top.first) continue;
      top.first = t;
      top.second.place_x = cells.centres[c].x();
      top.second.place_y = cells.centres[c].y();
      top.second.place_radius = radius;
    }
    if (top.first <= 0.0) continue;
    top.second.kind = CandidateKind::kPlace;
    top.second.name = kExtraClass;
    top.second.unit = "1";
    top.second.effect = k;
    top.second.tau = plausible_size();
    discs.push_back(top);
  }
  std::stable_sort(discs.begin(), discs.end(),
                   [](const Scored& a, const Scored& b) { return a.first > b.first; });
  return discs;
}

}  // namespace

std::vector<Candidate> resurfaced_places(const FrictionReadings& readings,
                                         const SurfaceClasses& classes,
                                         const PlaceCells& cells,
                                         const Eigen::VectorXd& residuals,
                                         std::size_t most) {
  struct OfClass {
    ClassReadings own;
    std::vector<Scored> discs;
  };
  std::vector<OfClass> found;
  for (std::size_t k = 0; k < classes.labels.size(); ++k) {
    OfClass one{readings_of(readings, classes, residuals, k), {}};
    std::vector<std::size_t> cell_of;
    for (std::size_t i = 0; i < readings.samples.size(); ++i)
      if (classes.of[i] == k) cell_of.push_back(cells.of[i]);
    one.discs = coarse_discs(one.own, cell_of, cells, k);
    if (!one.discs.empty()) found.push_back(std::move(one));
  }
  std::stable_sort(found.begin(), found.end(), [](const OfClass& a, const OfClass& b) {
    return a.discs.front().first > b.discs.front().first;
  });
  const double looked_at =
      static_cast<double>(classes.labels.size() * std::size(kRadii) * cells.centres.size());
  std::vector<Candidate> places;
  for (std::size_t i = 0; i < std::min(most, found.size()); ++i) {
    // Refines from every radius with at least half of the best chi-squared: a disc that is too
    // large may be a local maximum.
    Scored best{-1.0, {}};
    for (const Scored& disc : found[i].discs) {
      if (disc.first < 0.5 * found[i].discs.front().first) break;
      if (Scored end = moved(found[i].own, disc.second); end.first > best.first)
        best = std::move(end);
    }
    best.second.penalty = std::log(looked_at);
    places.push_back(best.second);
  }
  return places;
}

Candidate moved_surface(const FrictionReadings& readings,
                        const SurfaceClasses& classes,
                        const Eigen::VectorXd& residuals,
                        const Candidate& place) {
  constexpr double kNear = 0.1;  // relative to the radius
  return moved(readings_of(readings, classes, residuals, place.effect), place, kNear).second;
}

bool touches_disc(const std::vector<Candidate>& discs, const Candidate& place) {
  return std::any_of(discs.begin(), discs.end(), [&](const Candidate& c) {
    return c.effect == place.effect &&
           std::hypot(c.place_x - place.place_x, c.place_y - place.place_y) <
               1.2 * (c.place_radius + place.place_radius);
  });
}

}  // namespace roadbook
