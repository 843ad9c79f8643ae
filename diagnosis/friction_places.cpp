#include "diagnosis/friction_places.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

constexpr const char* kExtraClass = "friction0.extra_class";

// Sum and number of residuals inside, beside the number of the class and its sum: chi-squared of
// the difference between inside and outside.
double statistic(double sum, double inside, double class_sum, double count) {
  if (inside < 3.0 || count - inside < 3.0) return 0.0;
  const double u = sum - inside / count * class_sum;
  return u * u / (inside * (1.0 - inside / count));
}

double statistic_of(const FrictionReadings& readings,
                    const SurfaceClasses& classes,
                    const Eigen::VectorXd& residuals,
                    const Candidate& c) {
  double sum = 0.0, inside = 0.0, class_sum = 0.0, count = 0.0;
  const double square = c.place_radius * c.place_radius;
  for (std::size_t i = 0; i < readings.samples.size(); ++i) {
    if (classes.of[i] != c.effect) continue;
    const double r = residuals[static_cast<Eigen::Index>(i)];
    count += 1.0;
    class_sum += r;
    const double dx = readings.samples[i].x - c.place_x;
    const double dy = readings.samples[i].y - c.place_y;
    if (dx * dx + dy * dy >= square) continue;
    inside += 1.0;
    sum += r;
  }
  return statistic(sum, inside, class_sum, count);
}

double plausible_size() {
  for (const EffectInfo& e : reading_effects())
    if (e.name == kExtraClass) return e.plausible;
  return 0.2;
}

}  // namespace

std::vector<Candidate> resurfaced_places(const FrictionReadings& readings,
                                         const SurfaceClasses& classes,
                                         const PlaceCells& cells,
                                         const Eigen::VectorXd& residuals,
                                         std::size_t most) {
  const std::size_t m = cells.centres.size();
  std::vector<std::pair<double, Candidate>> best;
  double looked_at = 0.0;
  for (std::size_t k = 0; k < classes.labels.size(); ++k) {
    std::vector<double> sums(m, 0.0), counts(m, 0.0);
    double class_sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < readings.samples.size(); ++i) {
      if (classes.of[i] != k) continue;
      const double r = residuals[static_cast<Eigen::Index>(i)];
      sums[cells.of[i]] += r;
      counts[cells.of[i]] += 1.0;
      class_sum += r;
      count += 1.0;
    }
    std::pair<double, Candidate> top{0.0, {}};
    for (const double radius : {5.0, 8.0, 13.0, 20.0, 32.0, 50.0})
      for (std::size_t c = 0; c < m; ++c) {
        double sum = 0.0, inside = 0.0;
        for (std::size_t d = 0; d < m; ++d)
          if ((cells.centres[d] - cells.centres[c]).squaredNorm() < radius * radius) {
            sum += sums[d];
            inside += counts[d];
          }
        looked_at += 1.0;
        const double t = statistic(sum, inside, class_sum, count);
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
    best.push_back(top);
  }
  std::stable_sort(best.begin(), best.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Candidate> places;
  for (std::size_t i = 0; i < std::min(most, best.size()); ++i) {
    places.push_back(best[i].second);
    places.back().penalty = std::log(looked_at);
  }
  return places;
}

Candidate resurfaced_near(const FrictionReadings& readings,
                          const SurfaceClasses& classes,
                          const Eigen::VectorXd& residuals,
                          Candidate place) {
  double best = statistic_of(readings, classes, residuals, place);
  for (double step = 0.3; step > 0.004; step *= 0.7) {
    const Candidate centre = place;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = -1; k <= 1; ++k) {
          Candidate c = centre;
          c.place_x += step * centre.place_radius * i;
          c.place_y += step * centre.place_radius * j;
          c.place_radius *= 1.0 + step * k;
          const double t = statistic_of(readings, classes, residuals, c);
          if (t <= best) continue;
          best = t;
          place = c;
        }
  }
  return place;
}

}  // namespace roadbook
