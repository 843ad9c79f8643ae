#include "sim/useful_effects.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "sim/streams/friction_stream.hpp"

namespace roadbook {
namespace {

bool anybody_walks(const Scenario& scenario) {
  return std::any_of(scenario.pedestrians.begin(), scenario.pedestrians.end(), [&](const auto& p) {
    return p.count > 0 &&
           std::find(p.visits.begin(), p.visits.end(), scenario.visit) != p.visits.end();
  });
}

// The first visit at which a detector of people would find a person.
std::string somebody_to_detect(const Scenario& scenario) {
  std::string want = "somebody to detect: nobody walks in " + scenario.name + " at visit " +
                     std::to_string(scenario.visit);
  int first = -1;
  for (const PedestrianSpec& p : scenario.pedestrians)
    for (const int visit : p.visits)
      if (p.count > 0 && (first < 0 || visit < first)) first = visit;
  return first < 0 ? want + " or any other" : want + "; try --visit " + std::to_string(first);
}

bool is_of_camera(const std::string& sensor) {
  return sensor == "rig" || sensor == "cam" || sensor == "cam0" || sensor == "cam1" ||
         sensor == "cam2" || sensor == "cam3";
}

// Whether nothing that is recorded shows the effect, for want of images.
bool wants_images(const std::string& name, const SimulateOptions& options) {
  if (options.images) return false;
  if (is_of_camera(name.substr(0, name.find('.')))) return true;
  // Of people one sees the feet on the ground, of a scanner's readings some end at parked cars.
  if (name == "ground.height")
    return !options.detections && !has_effects_of(options.effects, "detector.");
  const bool ranges = options.ranges || has_effects_of(options.effects, "range0.");
  return (name == "map.moved_landmarks" || name == "map.landmarks_gone") && !ranges;
}

Problem useless(const std::string& name, const std::string& want) {
  Problem problem;
  problem.field = "effects";
  problem.got = name;
  problem.want = want;
  return problem;
}

bool same(const std::vector<WheelReading>& a, const std::vector<WheelReading>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.t_ns == y.t_ns && x.left_angle_rad == y.left_angle_rad &&
           x.right_angle_rad == y.right_angle_rad && x.steering_rad == y.steering_rad;
  });
}
bool same(const std::vector<ImuReading>& a, const std::vector<ImuReading>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.t_ns == y.t_ns && x.angular_velocity_rad_s == y.angular_velocity_rad_s &&
           x.specific_force_m_s2 == y.specific_force_m_s2;
  });
}
bool same(const std::vector<FrictionReading>& a, const std::vector<FrictionReading>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.t_ns == y.t_ns && x.friction == y.friction && x.sigma == y.sigma &&
           x.surface == y.surface && x.temperature_c == y.temperature_c;
  });
}

template <typename Reading>
std::vector<Reading> until(std::int64_t last_ns, std::vector<Reading> readings) {
  std::erase_if(readings, [&](const Reading& r) { return r.t_ns > last_ns; });
  return readings;
}

}  // namespace

bool has_effects_of(const EffectSizes& effects, const std::string& prefix) {
  const auto first = effects.lower_bound(prefix);
  return first != effects.end() && first->first.starts_with(prefix);
}

void refuse_effects_without_use(const Scenario& scenario, const SimulateOptions& options) {
  std::vector<Problem> problems;
  for (const auto& [name, size] : options.effects) {
    const std::string sensor = name.substr(0, name.find('.'));
    if (size != 0.0 && wants_images(name, options)) {
      problems.push_back(useless(
          name,
          "images, which this drive is without: nothing else that it records shows the effect"));
      continue;
    }
    const bool everywhere = is_of_camera(sensor) || sensor == "wheels0" || sensor == "steering0" ||
                            sensor == "clock" || (sensor == "ground" && name != "ground.bank") ||
                            sensor == "map";
    // A scanner has no beacons.
    const bool range = sensor == "range0" && name != "range0.bias" && name != "range0.scale";
    const bool imu = sensor == "imu0" && scenario.imu;
    const bool friction = sensor == "friction0" && scenario.friction;
    const bool detector = sensor == "detector" && anybody_walks(scenario);
    if (everywhere || imu || friction || range || detector) continue;
    problems.push_back(useless(
        name, sensor == "detector"
                  ? somebody_to_detect(scenario)
                  : "an effect that is simulated; this one is not simulated in " + scenario.name));
  }
  if (!problems.empty()) throw BadInput(problems);
}

void refuse_effects_without_change(const World& world,
                                   const VehicleMotion& drive,
                                   std::int64_t start_ns,
                                   std::int64_t last_ns,
                                   const StreamOptions& streams) {
  const auto wheels = [&](const StreamOptions& s) {
    return until(last_ns, simulate_wheels(world, drive, start_ns, s));
  };
  const auto imu = [&](const StreamOptions& s) {
    return until(last_ns, simulate_imu(drive, start_ns, s));
  };
  const auto friction = [&](const StreamOptions& s) {
    return until(last_ns, simulate_friction(world, drive, start_ns, s, true));
  };
  std::vector<Problem> problems;
  for (const auto& [name, size] : streams.effects) {
    if (size == 0.0) continue;
    StreamOptions without = streams;
    without.effects.erase(name);
    const std::string sensor = name.substr(0, name.find('.'));
    const bool unchanged = sensor == "wheels0" || sensor == "steering0" || sensor == "clock"
                               ? same(wheels(streams), wheels(without))
                           : sensor == "imu0"      ? same(imu(streams), imu(without))
                           : sensor == "friction0" ? same(friction(streams), friction(without))
                                                   : false;
    if (unchanged)
      problems.push_back(
          useless(name,
                  "an effect that changes a reading of this drive: it meets nothing that "
                  "shows this one"));
  }
  if (!problems.empty()) throw BadInput(problems);
}

}  // namespace roadbook
