#include "speedmap/experiments/wet_patch_study.hpp"

#include <algorithm>
#include <cmath>

#include "base/gravity.hpp"
#include "base/random.hpp"
#include "speedmap/presence/presence_map.hpp"
#include "speedmap/property_map/property_mapper.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {
namespace {

constexpr double kLength_m = 140.0;
constexpr double kHalfWidth_m = 3.0;
constexpr double kDriven_m = 60.0;

// What a road is really like.
struct Road {
  double first_from, first_to, second_from, second_to;  ///< wet patches [m]
  double dry, wet;                                      ///< mean friction of the classes
  double curvature;                                     ///< about the second patch
  [[nodiscard]] bool is_wet(double s) const {
    return (s >= first_from && s < first_to) || (s >= second_from && s < second_to);
  }
};

Road drawn_road(Random& random) {
  Road road{};
  road.first_from = random.uniform(15.0, 25.0);
  road.first_to = road.first_from + random.uniform(8.0, 20.0);
  road.second_from = random.uniform(85.0, 100.0);
  road.second_to = road.second_from + random.uniform(5.0, 25.0);
  road.dry = random.uniform(0.75, 0.95);
  road.wet = random.uniform(0.3, 0.6);
  road.curvature = 1.0 / random.uniform(15.0, 60.0);
  return road;
}

PropertyMapPrior prior() {
  PropertyMapPrior prior;
  prior.classes = {"dry", "wet"};
  prior.counts = {3.0, 1.0};
  PropertyPrior friction;
  friction.classes = {{0.8, 2.0, 2.0, 0.01}, {0.5, 2.0, 2.0, 0.01}};
  prior.properties.push_back(friction);
  return prior;
}

PropertyMap learn(const Road& road, const WetPatchOptions& options, Random& random) {
  KnotGridOptions grid;
  grid.length_m = kLength_m;
  grid.e_min_m = -kHalfWidth_m;
  grid.e_max_m = kHalfWidth_m;
  PropertyMapper mapper(PropertyMap(Knots::grid(grid), prior()));
  for (double s = 0.5; s < kLength_m; s += 0.5)
    for (double e = -kHalfWidth_m + 0.25; e < kHalfWidth_m; e += 0.5) {
      const bool wrong = random.uniform() < options.mislabelled;
      (void)mapper.map().add_label({s, e}, road.is_wet(s) != wrong ? 1 : 0, 2.0);
    }
  for (double s = 0.5; s < kDriven_m; s += 0.15) {
    const double mu = (road.is_wet(s) ? road.wet : road.dry) + random.normal(0.0, 0.02);
    const double reading = std::clamp(mu + random.normal(0.0, options.reading_sigma), 0.0, 1.5);
    (void)mapper.add_value(0, {s, random.normal(0.0, 0.2)}, reading, options.reading_sigma);
    (void)mapper.travelled(s);
  }
  mapper.refresh();
  return mapper.map();
}

std::vector<LaneSpeed> drive(const Road& road,
                             const PropertyMap& map,
                             const LaneSpeedOptions& options) {
  std::vector<WayPoint> way;
  std::vector<double> s;
  for (double at = 0.0; at <= kLength_m; at += options.step_m) {
    s.push_back(at);
    way.push_back({{at, 0.0}, {0.0, 1.0}, at > 70.0 ? road.curvature : 0.0});
  }
  const FrictionAt friction = [&](double at, double e) { return map.moments(0, {at, e}); };
  auto places = speed_limits_along(way, s, options.max_speed, {}, friction, options);
  make_feasible(places, options.step_m, false, options);
  return places;
}

}  // namespace

WetPatchResult wet_patch_study(const WetPatchOptions& options) {
  LaneSpeedOptions speed;
  speed.max_speed = 30.0;
  speed.grip_quantile = options.quantile;
  speed.sight_m = 60.0;
  speed.motion = {2.0, 3.0, 6.0, 4.0};
  WetPatchResult result;
  double places_in_patch = 0.0;
  for (int k = 0; k < options.cases; ++k) {
    Random random(options.seed, "wet patch", static_cast<std::uint64_t>(k));
    const Road road = drawn_road(random);
    const auto places = drive(road, learn(road, options, random), speed);
    const double known = grip_speed(road.wet, road.curvature, speed);
    bool above = false;
    bool beyond = false;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const LaneSpeed& at = places[i];
      if (at.s_m < road.second_from || at.s_m >= road.second_to) continue;
      above = above || at.speed > known;
      const double along =
          (places[i + 1].speed * places[i + 1].speed - at.speed * at.speed) / (2.0 * speed.step_m);
      const double across = at.speed * at.speed * road.curvature;
      beyond = beyond || std::hypot(along, across) > road.wet * kGravity;
      result.mean_speed += at.speed;
      result.mean_speed_known += known;
      places_in_patch += 1.0;
    }
    ++result.cases;
    result.above_grip += above ? 1 : 0;
    result.beyond_circle += beyond ? 1 : 0;
  }
  result.mean_speed /= std::max(places_in_patch, 1.0);
  result.mean_speed_known /= std::max(places_in_patch, 1.0);
  return result;
}

double false_calm(
    double p, double prior_presence, double calm, int visits, int places, std::uint64_t seed) {
  PresenceGraph graph;
  graph.nodes.assign(static_cast<std::size_t>(places), {prior_presence, 1.0});
  PresenceMap map(std::move(graph));
  Random random(seed, "false calm");
  for (int visit = 0; visit < visits; ++visit) {
    std::vector<PresenceObservation> seen;
    for (int i = 0; i < places; ++i) seen.push_back({i, random.uniform() < p ? 1.0 : 0.0, 1.0});
    map.add(seen);
  }
  map.solve();
  return static_cast<double>((map.presence().array() < calm).count()) / places;
}

}  // namespace roadbook
