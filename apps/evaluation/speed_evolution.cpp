#include "apps/evaluation/speed_evolution.hpp"

#include <cmath>

#include "sim/scenario/scenario.hpp"
#include "sim/world/layout.hpp"
#include "sim/world/moving.hpp"
#include "sim/world/paint.hpp"
#include "sim/world/path.hpp"
#include "speedmap/presence/presence_map.hpp"

namespace roadbook {
namespace {

constexpr int kVisits = 7;
constexpr double kStep_s = 0.2;

Scenario zurich(int visit) {
  ScenarioOptions options;
  options.visit = visit;
  return load_scenario("zurich", options);
}

PresenceGrid simulated_grid(const Scenario& scenario, const PresenceOptions& options) {
  std::vector<GridLane> lanes;
  for (const LaneSpec& lane : scenario.lanes) {
    const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
    lanes.push_back({line.sampled(1.0), lane.width_m});
    if (lane.closed) lanes.back().centre.push_back(lanes.back().centre.front());
  }
  std::vector<Outline> spaces;
  for (const ParkingSpace& space : make_layout(scenario).spaces) spaces.push_back(space.corners);
  std::vector<Outline> crossings;
  for (const CrossingSpec& c : scenario.crossings)
    crossings.push_back(strip(c.from, c.to, c.width_m));
  return {lanes, spaces, crossings, options};
}

std::vector<SightBlocker> simulated_blockers(const Scenario& scenario) {
  std::vector<SightBlocker> blockers;
  for (const WallSpec& wall : scenario.walls) blockers.push_back({wall.from, wall.to});
  for (const BlockSpec& block : scenario.blocks)
    add_sides(rectangle(block.at, block.heading, block.size), blockers);
  for (const ParkedCar& car : make_layout(scenario).cars)
    add_sides(rectangle(car.centre, car.heading, {4.2, 1.7}), blockers);
  return blockers;
}

std::vector<VisitFrame> drive(const Scenario& scenario,
                              const std::vector<SightBlocker>& blockers,
                              double range_m,
                              std::uint64_t seed) {
  Random driver(seed, "driver", static_cast<std::uint64_t>(scenario.visit));
  const VehicleMotion motion = drive_line(
      route_line(scenario, scenario.route), scenario.laps[static_cast<std::size_t>(scenario.visit)],
      scenario.stops, scenario.vehicle, Ground(scenario.ground), {}, driver);
  const Pedestrians people(scenario, motion, seed);
  std::vector<VisitFrame> frames;
  for (double t = 0.0; t < motion.duration_s(); t += kStep_s) {
    const VehicleState state = motion.at(t);
    VisitFrame frame;
    frame.position = {state.x, state.y};
    frame.duration_s = kStep_s;
    for (std::size_t i = 0; i < people.count(); ++i) {
      const PersonState person = people.at(i, t);
      const Eigen::Vector2d p(person.x, person.y);
      if ((p - frame.position).norm() < range_m && in_sight(frame.position, p, blockers))
        frame.people.push_back({p, 0.1, 1.0});
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

// Returns the nodes of a crossing over the lanes, within 3 m of the ring's centre line.
std::vector<int> danger_nodes(const PresenceGrid& grid, const Scenario& scenario, double x) {
  const DrivingLine ring(scenario.lanes.front().points, scenario.vehicle.turn_radius_m, true);
  std::vector<int> nodes;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Eigen::Vector2d& p = grid.centres()[i];
    if (std::abs(p.x() - x) > 1.0 || grid.place_class(i) != PlaceClass::kCrossing) continue;
    const double s = ring.nearest(p, 0.0, ring.length_m());
    if ((ring.at(s) - p).norm() < 3.0) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

double mean_presence(const Eigen::VectorXd& presence, const std::vector<int>& nodes) {
  double sum = 0.0;
  for (const int node : nodes) sum += presence[node];
  return sum / static_cast<double>(nodes.size());
}

}  // namespace

SpeedEvolution zurich_evolution(const PresenceOptions& options,
                                const SightOptions& sight,
                                std::uint64_t seed,
                                const std::vector<std::vector<VisitFrame>>& seen) {
  const Scenario first = zurich(0);
  SpeedEvolution result{simulated_grid(first, options), {}, {}, {}, {}, {}};
  const auto left = danger_nodes(result.grid, first, first.crossing("left").from.x());
  const auto right = danger_nodes(result.grid, first, first.crossing("right").from.x());
  std::vector<int> lanes;
  for (std::size_t i = 0; i < result.grid.size(); ++i)
    if (result.grid.place_class(i) == PlaceClass::kLane &&
        std::abs(result.grid.centres()[i].x() - 31.0) < 10.0)
      lanes.push_back(static_cast<int>(i));
  PresenceMap map(result.grid.graph());
  for (int visit = 0; visit < kVisits; ++visit) {
    const Scenario scenario = zurich(visit);
    const auto blockers = simulated_blockers(scenario);
    const auto v = static_cast<std::size_t>(visit);
    const auto frames = v < seen.size() && !seen[v].empty()
                            ? seen[v]
                            : drive(scenario, blockers, sight.range_m, seed);
    const VisitEvidence evidence = gather_evidence(result.grid, frames, blockers, sight);
    map.add(observations_of(result.grid, evidence, frames, sight));
    map.solve();
    result.people.emplace_back();
    for (const VisitFrame& frame : frames)
      for (const SeenPerson& person : frame.people) result.people.back().push_back(person.position);
    result.presence.emplace_back(map.presence().begin(), map.presence().end());
    result.left.push_back(mean_presence(map.presence(), left));
    result.right.push_back(mean_presence(map.presence(), right));
    result.lanes.push_back(mean_presence(map.presence(), lanes));
  }
  return result;
}

}  // namespace roadbook
