#include <cmath>
#include <numbers>

#include "sim/world/blob.hpp"
#include "sim/world/ground_marks.hpp"
#include "sim/world/path.hpp"

// What time and traffic leave on a floor, under its paint and over it.

namespace roadbook {
namespace {

double ares(const GroundSpec& ground) { return (ground.high - ground.low).prod() / 100.0; }

Eigen::Vector2d anywhere(const GroundSpec& ground, Random& random) {
  const double x = random.uniform(ground.low.x(), ground.high.x());
  return {x, random.uniform(ground.low.y(), ground.high.y())};
}

void paint_crack(Canvas& ground, const Eigen::Vector2d& start, Random& random) {
  Eigen::Vector2d at = start;
  double heading = random.uniform(0.0, 2.0 * std::numbers::pi);
  const int pieces = 10 + static_cast<int>(random.below(30));
  const double width = random.uniform(0.006, 0.018);
  for (int i = 0; i < pieces; ++i) {
    heading += 0.45 * random.normal();
    const Eigen::Vector2d next =
        at + random.uniform(0.04, 0.16) * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    fill_convex(ground, strip(at, next, width), 30, 0.75);
    at = next;
  }
}

/// Two dark bands where tyres have run, strongest in bends.
void paint_tyre_marks(const Scenario& scenario, Canvas& ground, Random& random) {
  for (const LaneSpec& lane : scenario.lanes) {
    const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
    const int marks = 3 + static_cast<int>(line.length_m() / 12.0);
    for (int m = 0; m < marks; ++m) {
      const double start = random.uniform(0.0, line.length_m());
      const double length = random.uniform(1.5, 7.0);
      const double aside = random.uniform(-0.5, 0.5) + (random.below(2) == 0 ? 0.75 : -0.75);
      const double bend = 0.02 * random.normal();
      const double opacity = random.uniform(0.08, 0.3);
      const auto point = [&](double s) {
        const double h = line.heading(s);
        return Eigen::Vector2d(line.at(s) + (aside + bend * (s - start) * (s - start)) *
                                                Eigen::Vector2d(-std::sin(h), std::cos(h)));
      };
      for (double s = start; s < start + length; s += 0.25)
        fill_convex(ground, strip(point(s), point(s + 0.25), 0.17), 25, opacity, 0.03);
    }
  }
}

}  // namespace

void paint_wear(const Scenario& scenario, const Layout& layout, Canvas& ground) {
  const GroundSpec& spec = scenario.ground;
  Random random(scenario.seed, "wear");
  const auto many = [&](double per_are) { return static_cast<int>(ares(spec) * per_are + 0.5); };
  for (int i = many(0.35 * spec.cracks_per_are); i > 0; --i)
    fill_convex(ground,
                rectangle(anywhere(spec, random), random.uniform(0.0, 0.3),
                          {random.uniform(0.5, 2.5), random.uniform(0.4, 1.6)}),
                255.0 * spec.brightness * random.uniform(0.7, 1.25), 0.45);
  for (int i = many(spec.cracks_per_are); i > 0; --i)
    paint_crack(ground, anywhere(spec, random), random);
  for (int i = many(0.3 * spec.cracks_per_are); i > 0; --i) {
    const Eigen::Vector2d a = anywhere(spec, random);
    const double heading = random.below(2) == 0 ? 0.02 : 1.59;
    fill_convex(
        ground,
        strip(a,
              a + random.uniform(1.0, 5.0) * Eigen::Vector2d(std::cos(heading), std::sin(heading)),
              0.03),
        35, 0.8);
  }
  paint_tyre_marks(scenario, ground, random);
  for (const ParkingSpace& space : layout.spaces)  // engines drip where engines stand
    for (int i = 0; i < 4; ++i)
      fill_convex(ground,
                  blob(space.centre + Eigen::Vector2d(0.7 * random.normal(), 0.7 * random.normal()),
                       random.uniform(0.04, 0.25), random),
                  25, random.uniform(0.1, 0.45), 0.04);
}

void paint_dirt(const Scenario& scenario, Canvas& ground) {
  const GroundSpec& spec = scenario.ground;
  Random random(scenario.seed, "dirt");
  const int count = static_cast<int>(ares(spec) * spec.stains_per_are + 0.5);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at = anywhere(spec, random);
    const double what = random.uniform();
    if (what < 0.45)
      fill_convex(ground, blob(at, random.uniform(0.012, 0.035), random),
                  random.below(2) == 0 ? 30 : 175, random.uniform(0.4, 0.8));
    else if (what < 0.75)
      fill_convex(ground, blob(at, random.uniform(0.05, 0.3), random), 35, random.uniform(0.1, 0.4),
                  0.03);
    else
      fill_convex(ground,
                  rectangle(at, random.uniform(0.0, 3.1),
                            {random.uniform(0.03, 0.12), random.uniform(0.02, 0.06)}),
                  random.uniform(60.0, 220.0), 0.7);
  }
}

}  // namespace roadbook
