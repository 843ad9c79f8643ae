#include "diagnosis/reading_diagnosis.hpp"

#include <algorithm>
#include <memory>

#include "diagnosis/detector_diagnosis.hpp"
#include "diagnosis/friction/friction_problem.hpp"
#include "diagnosis/known_causes.hpp"
#include "diagnosis/range/range_diagnosis.hpp"
#include "diagnosis/sessions_diagnosis.hpp"

namespace roadbook {
namespace {

// Describes what the covariates of the readings cannot show.
std::vector<std::string> constant_covariates(const FrictionReadings& readings) {
  std::vector<std::string> notes;
  if (!readings.has_temperature) {
    notes.emplace_back(
        "friction0: no temperature is logged; effects that depend on it are not observable");
    return notes;
  }
  const Eigen::VectorXd t = friction_covariate(readings.samples, "temperature");
  if (t.maxCoeff() - t.minCoeff() < 1.0)
    notes.emplace_back(
        "friction0: the temperature varies by less than 1 K; effects that depend on it are not "
        "observable");
  return notes;
}

// Notes of a drive, by its name where there are several.
void add_notes(const std::vector<std::string>& notes, const std::string& drive, Diagnosis& all) {
  for (const std::string& note : notes)
    all.notes.push_back(drive.empty() ? note : drive + ": " + note);
}

Diagnosis diagnose_friction(const std::vector<SessionReadings>& drives,
                            const SearchOptions& search,
                            const LibraryOptions& library) {
  std::vector<std::unique_ptr<FrictionProblem>> problems;
  std::vector<SessionProblem> sessions;
  Diagnosis notes;
  for (const SessionReadings& drive : drives) {
    const FrictionReadings& friction = drive.readings->friction;
    add_notes(friction.notes, drive.name, notes);
    if (friction.samples.empty()) continue;
    problems.push_back(std::make_unique<FrictionProblem>(friction, library));
    sessions.push_back({drive.name, problems.back().get()});
    add_notes(constant_covariates(friction), drive.name, notes);
  }
  Diagnosis d = diagnose_together(sessions, search);
  add_notes(notes.notes, "", d);
  return d;
}

Diagnosis diagnose_beacons(const std::vector<SessionReadings>& drives,
                           const SearchOptions& search,
                           const LibraryOptions& library) {
  std::vector<std::unique_ptr<BeaconProblem>> problems;
  std::vector<SessionProblem> sessions;
  Diagnosis notes;
  for (const SessionReadings& drive : drives) {
    const BeaconReadings& beacons = drive.readings->beacons;
    add_notes(beacons.notes, drive.name, notes);
    if (beacons.samples.empty()) continue;
    problems.push_back(std::make_unique<BeaconProblem>(beacons, library));
    sessions.push_back({drive.name, problems.back().get()});
  }
  Diagnosis d = diagnose_together(sessions, search);
  add_notes(notes.notes, "", d);
  return d;
}

Diagnosis diagnose_range_readings(const std::vector<SessionReadings>& drives,
                                  const LibraryOptions& library,
                                  const EffectSizes& known) {
  std::vector<SessionRanges> ranges;
  for (const SessionReadings& drive : drives)
    if (!drive.readings->ranges.samples.empty() || !drive.readings->ranges.notes.empty())
      ranges.push_back({drive.name, &drive.readings->ranges});
  if (ranges.size() == 1 && drives.size() == 1)
    return diagnose_ranges(*ranges.front().readings, library.without, known);
  return diagnose_ranges(ranges, library.without);
}

Diagnosis diagnose_detectors(const std::vector<SessionReadings>& drives,
                             const SearchOptions& search,
                             const LibraryOptions& library,
                             const EffectSizes& known) {
  std::vector<DriveSightings> sightings;
  for (const SessionReadings& drive : drives)
    if (!drive.readings->people.looks.empty())
      sightings.push_back({drive.name, &drive.readings->people});
  return diagnose_detector(sightings, search, library, known);
}

}  // namespace

DriveReadings drive_readings(const Drive& drive,
                             const std::vector<PoseSample>& poses,
                             const EffectSizes& known) {
  const double late_s = effect_size(known, "cam", "latency");
  return {friction_readings(drive, poses, late_s),
          range_readings(drive, poses, late_s),
          {},
          sighting_readings(drive, poses)};
}

Diagnosis diagnose_readings(const DriveReadings& readings,
                            const SearchOptions& search,
                            const LibraryOptions& library,
                            const EffectSizes& known) {
  return diagnose_readings({{"", &readings}}, search, library, known);
}

Diagnosis diagnose_readings(const std::vector<SessionReadings>& drives,
                            const SearchOptions& search,
                            const LibraryOptions& library,
                            const EffectSizes& known) {
  std::vector<DriveReadings> less;
  std::vector<SessionReadings> left = drives;
  less.reserve(drives.size());
  for (SessionReadings& drive : left)
    if (!known.empty()) drive.readings = &less.emplace_back(without_known(*drive.readings, known));
  Diagnosis all = diagnose_friction(left, search, library);
  add_findings(diagnose_range_readings(left, library, known), all);
  add_findings(diagnose_beacons(left, search, library), all);
  add_findings(diagnose_detectors(left, search, library, known), all);
  take_off_known(known, all);
  return all;
}

}  // namespace roadbook
