#include "sim/useful_effects.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace roadbook {
namespace {

bool anybody_walks(const Scenario& scenario) {
  return std::any_of(scenario.pedestrians.begin(), scenario.pedestrians.end(), [&](const auto& p) {
    return p.count > 0 &&
           std::find(p.visits.begin(), p.visits.end(), scenario.visit) != p.visits.end();
  });
}

// The first visit at which a detector of people would find somebody.
std::string somebody_to_detect(const Scenario& scenario) {
  std::string want = "somebody to detect: nobody walks in " + scenario.name + " at visit " +
                     std::to_string(scenario.visit);
  int first = -1;
  for (const PedestrianSpec& p : scenario.pedestrians)
    for (const int visit : p.visits)
      if (p.count > 0 && (first < 0 || visit < first)) first = visit;
  return first < 0 ? want + " or any other" : want + "; try --visit " + std::to_string(first);
}

}  // namespace

void refuse_effects_without_use(const Scenario& scenario, const EffectSizes& effects) {
  std::vector<Problem> problems;
  for (const auto& [name, size] : effects) {
    const std::string sensor = name.substr(0, name.find('.'));
    const bool camera = sensor == "cam" || sensor == "cam0" || sensor == "cam1" ||
                        sensor == "cam2" || sensor == "cam3";
    const bool everywhere = camera || sensor == "wheels0" || sensor == "steering0" ||
                            sensor == "clock" || sensor == "ground" || sensor == "map";
    // A scanner has no beacons.
    const bool range = sensor == "range0" && name != "range0.bias" && name != "range0.scale";
    const bool imu = sensor == "imu0" && scenario.imu;
    const bool friction = sensor == "friction0" && scenario.friction;
    const bool detector = sensor == "detector" && anybody_walks(scenario);
    if (everywhere || imu || friction || range || detector) continue;
    Problem problem;
    problem.field = "effects";
    problem.got = name;
    problem.want = "an effect that is simulated; this one is not simulated in " + scenario.name;
    if (sensor == "detector") problem.want = somebody_to_detect(scenario);
    problems.push_back(problem);
  }
  if (!problems.empty()) throw BadInput(problems);
}

}  // namespace roadbook
