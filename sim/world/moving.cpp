#include "sim/world/moving.hpp"

#include <algorithm>
#include <cmath>

#include "base/se3.hpp"
#include "sim/world/path.hpp"
#include "sim/world/person.hpp"

namespace roadbook {
namespace {

bool in_visit(const std::vector<int>& visits, int visit) {
  return std::find(visits.begin(), visits.end(), visit) != visits.end();
}

/// Distance from `p` to the measuring car's body and the road it needs in the next seconds.
double clearance_m(const VehicleMotion& drive, double t_s, const Eigen::Vector2d& p) {
  double nearest = 1e9;
  for (const double ahead : {0.0, 0.7, 1.4}) {
    const VehicleState s = drive.at(t_s + ahead);
    const Eigen::Vector2d forward(std::cos(s.heading), std::sin(s.heading));
    const Eigen::Vector2d to = p - Eigen::Vector2d(s.x, s.y);
    const double along = std::clamp(forward.dot(to), -0.8, 3.5);
    nearest = std::min(nearest, (to - along * forward).norm());
  }
  return nearest;
}

std::vector<PersonState> walk(const CrossingSpec& crossing,
                              double speed,
                              const VehicleMotion& drive,
                              Random& random) {
  const Eigen::Vector2d way = crossing.to - crossing.from;
  const double length = way.norm();
  const Eigen::Vector2d along = way / length;
  const Eigen::Vector2d aside(-along.y(), along.x());
  const double lane = random.uniform(-0.35, 0.35) * crossing.width_m;
  const double own_speed = speed * random.uniform(0.85, 1.15);
  double s = random.uniform(0.0, length);
  double direction = random.below(2) == 0 ? 1.0 : -1.0;
  PersonState now;
  std::vector<PersonState> track;
  const auto place = [&] { return Eigen::Vector2d(crossing.from + s * along + lane * aside); };
  for (double t = 0.0; t <= drive.duration_s() + Pedestrians::kStep; t += Pedestrians::kStep) {
    const double before = s;
    const double clear_before = clearance_m(drive, t, place());
    s += direction * own_speed * Pedestrians::kStep;
    if (s < 0.0 || s > length) {
      direction = -direction;
      s = std::clamp(s, 0.0, length);
    }
    // Pedestrians do not walk into the car; a pedestrian close to it walks only if the distance
    // grows.
    const double clear = clearance_m(drive, t, place());
    if (clear < 2.0 && clear <= clear_before) s = before;
    now.walked_m += std::abs(s - before);
    now.x = place().x();
    now.y = place().y();
    now.heading = std::atan2(direction * along.y(), direction * along.x());
    track.push_back(now);
  }
  return track;
}

}  // namespace

Pedestrians::Pedestrians(const Scenario& scenario, const VehicleMotion& drive, std::uint64_t seed) {
  std::uint64_t index = 0;
  for (const PedestrianSpec& people : scenario.pedestrians) {
    if (!in_visit(people.visits, scenario.visit)) continue;
    for (int i = 0; i < people.count; ++i) {
      Random random(seed + static_cast<std::uint64_t>(scenario.visit), "pedestrian", index++);
      tracks_.push_back(walk(scenario.crossing(people.crossing), people.speed, drive, random));
      heights_.push_back(random.uniform(1.55, 1.92));
    }
  }
}

PersonState Pedestrians::at(std::size_t person, double t_s) const {
  const auto& track = tracks_[person];
  const double u = std::clamp(t_s / kStep, 0.0, static_cast<double>(track.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(u), track.size() - 2);
  const double f = u - static_cast<double>(i);
  PersonState s = track[i];
  s.x += f * (track[i + 1].x - s.x);
  s.y += f * (track[i + 1].y - s.y);
  s.walked_m += f * (track[i + 1].walked_m - s.walked_m);
  return s;
}

Mesh moving_mesh(const World& world, const Pedestrians& people, double t_s) {
  Mesh mesh;
  for (std::size_t i = 0; i < people.count(); ++i) {
    const PersonState s = people.at(i, t_s);
    const int cloth = world.cloth_texture + 2 * static_cast<int>(i % 8);
    const double stride = 2.0 * 3.141592653589793 * s.walked_m / 1.4;
    Eigen::Isometry3d T = pose_from_planar(s.x, s.y, s.heading);
    T.translation().z() = world.ground.height(s.x, s.y);
    mesh.add(make_person(people.height_m(i), stride, cloth, world.skin_texture), T);
  }
  const Scenario& scenario = world.scenario;
  int model = 0;
  for (const TrafficSpec& car : scenario.traffic) {
    ++model;
    if (!in_visit(car.visits, scenario.visit)) continue;
    const DrivingLine line = route_line(scenario, car.route);
    const double s = std::fmod(car.start_m + car.speed * t_s, line.length_m());
    const Eigen::Vector2d p = line.at(s);
    mesh.add(world.other_cars[static_cast<std::size_t>(model % kCarModels)],
             world.ground.stand(p.x(), p.y(), line.heading(s), 2.6, 1.5));
  }
  return mesh;
}

}  // namespace roadbook
