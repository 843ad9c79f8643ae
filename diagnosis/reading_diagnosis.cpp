#include "diagnosis/reading_diagnosis.hpp"

#include <algorithm>

#include "diagnosis/detector_diagnosis.hpp"
#include "diagnosis/friction_problem.hpp"
#include "diagnosis/range_diagnosis.hpp"

namespace roadbook {
namespace {

template <typename T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void add_new(const std::vector<std::string>& from, std::vector<std::string>& to) {
  for (const std::string& name : from)
    if (!holds(to, name)) to.push_back(name);
}

bool shows(const Diagnosis& d, const std::string& name) {
  return holds(d.looked_for, name) && !holds(d.not_observable, name);
}

// What one of them shows is observable.
void add_not_observable(const Diagnosis& more, Diagnosis& all) {
  std::vector<std::string> names = more.not_observable;
  std::erase_if(names, [&](const std::string& name) { return shows(all, name); });
  std::erase_if(all.not_observable, [&](const std::string& name) { return shows(more, name); });
  add_new(names, all.not_observable);
}

// What the readings' own covariates cannot show, in words.
std::vector<std::string> constant_covariates(const FrictionReadings& readings) {
  std::vector<std::string> notes;
  if (!readings.has_temperature) {
    notes.emplace_back(
        "friction0: no temperature is logged, nothing that depends on it can be told");
    return notes;
  }
  const Eigen::VectorXd t = friction_covariate(readings.samples, "temperature");
  if (t.maxCoeff() - t.minCoeff() < 1.0)
    notes.emplace_back(
        "friction0: temperature varies by less than 1 K, nothing that depends on it can be told");
  return notes;
}

}  // namespace

DriveReadings drive_readings(const Drive& drive, const std::vector<PoseSample>& poses) {
  return {friction_readings(drive, poses),
          range_readings(drive, poses),
          {},
          sighting_readings(drive, poses)};
}

Diagnosis diagnose_readings(const DriveReadings& readings,
                            const SearchOptions& search,
                            const LibraryOptions& library) {
  Diagnosis all;
  append(readings.friction.notes, all.notes);
  if (!readings.friction.samples.empty()) {
    const FrictionProblem problem(readings.friction, library);
    add_findings(diagnose(problem, search), all);
    append(constant_covariates(readings.friction), all.notes);
  }
  add_findings(diagnose_ranges(readings.ranges, library.without), all);
  append(readings.beacons.notes, all.notes);
  if (!readings.beacons.samples.empty())
    add_findings(diagnose(BeaconProblem(readings.beacons, library), search), all);
  if (!readings.people.looks.empty())
    add_findings(diagnose_detector(readings.people, search, library), all);
  return all;
}

void add_findings(const Diagnosis& more, Diagnosis& all) {
  append(more.causes, all.causes);
  append(more.unknown, all.unknown);
  add_not_observable(more, all);
  add_new(more.looked_for, all.looked_for);
  append(more.unexplained, all.unexplained);
  append(more.notes, all.notes);
  append(more.before, all.before);
  append(more.after, all.after);
  for (const auto& [effect, size] : more.extended) all.extended[effect] = size;
  all.samples += more.samples;
  all.fit_gain += more.fit_gain;
  std::stable_sort(all.causes.begin(), all.causes.end(),
                   [](const FoundCause& a, const FoundCause& b) {
                     if (a.noise != b.noise) return b.noise;
                     return a.evidence > b.evidence;
                   });
}

}  // namespace roadbook
