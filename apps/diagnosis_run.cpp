#include "apps/diagnosis_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/detections.hpp"
#include "apps/localised_drive.hpp"
#include "base/digest.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/drive_streams.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/plain_log.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/sessions_diagnosis.hpp"
#include "drive/drive.hpp"
#include "mapping/map_file.hpp"
#include "mapping/session_track.hpp"

namespace roadbook {
namespace {

// Of people, what `roadbook detect` has left of the session in the map, at the map's poses; empty
// where it has not looked.
SightingReadings people_in_map(const std::filesystem::path& file,
                               const Map& map,
                               int session,
                               const Drive& drive) {
  const std::string& name = map.sessions[static_cast<std::size_t>(session)].name;
  const SessionTrack track(map, session);
  if (track.stamps().empty()) return {};
  const std::int64_t origin = track.stamps().front();
  std::vector<PoseSample> poses;
  for (const std::int64_t t : track.stamps())
    if (const auto T = track.at(t)) {
      const Eigen::Vector3d x = T->linear().col(0);
      poses.push_back({1e-9 * static_cast<double>(t - origin), T->translation().x(),
                       T->translation().y(), std::atan2(x.y(), x.x())});
    }
  for (const SessionSightings& one : stored_sightings(MapLayers(file), map))
    if (one.session == name)
      return sighting_readings(one.detections, one.looks, drive.rig(), poses, origin);
  return {};
}

// What moves, if anything is recorded of it, and what the other sensors read on the way.
Diagnosis diagnose_streams(const MotionStreams& streams,
                           const DriveReadings& readings,
                           const std::string& name,
                           const DiagnosisOptions& options) {
  const bool moves = !streams.wheels.empty() || !streams.steering.empty() || !streams.gyro.empty();
  if (!moves && !readings.empty() && streams.poses.size() > 1)
    return diagnose_readings(readings, options.search, options.library);
  Diagnosis all = diagnose(streams, name, options);
  add_findings(diagnose_readings(readings, options.search, options.library), all);
  return all;
}

DiagnosisRun of_log(const DiagnosisRequest& request, DiagnosisOptions options) {
  if (!request.map.empty())
    throw InvalidOption("--map", request.map.string(), "no map beside a plain log");
  const PlainLog log = read_plain_log(request.drive);
  auto& without = options.library.without;
  without.insert(without.end(), log.without.begin(), log.without.end());
  DiagnosisRun run{diagnose_streams(log.streams, log.readings, request.drive.string(), options),
                   log.name, sha256_file_hex(request.drive)};
  run.diagnosis.notes.insert(run.diagnosis.notes.begin(), log.notes.begin(), log.notes.end());
  return run;
}

DiagnosisRun of_drive(const DiagnosisRequest& request,
                      const DiagnosisOptions& options,
                      Console& console) {
  const Drive drive = Drive::open(request.drive);
  console.warn(drive.warnings());
  DiagnosisRun run{{}, drive.name(), drive.digest()};
  const MotionStreams streams = motion_streams(drive);
  DriveReadings readings = drive_readings(drive, streams.poses);
  if (request.map.empty()) {
    run.diagnosis = diagnose_streams(streams, readings, request.drive.string(), options);
    return run;
  }
  const Map map = load_map(request.map);
  if (const auto session = find_session(map, drive)) {
    run.diagnosis = diagnose_through_map(map, *session, drive, options);
    if (SightingReadings people = people_in_map(request.map, map, *session, drive);
        !people.looks.empty())
      readings.people = std::move(people);
  } else {
    const LocalisedDrive in_map = localised_drive(map, request.map, request.drive, console);
    run.diagnosis = diagnose_through_map(in_map.map, in_map.session, drive, options);
    run.diagnosis.notes.insert(run.diagnosis.notes.begin(),
                               "the drive is not in the map: it was localised in it");
  }
  add_findings(diagnose_readings(readings, options.search, options.library), run.diagnosis);
  return run;
}

// Names of drives as reports tell them apart.
std::string unique_name(const std::string& name, const std::vector<SessionStreams>& others) {
  const auto taken = [&](const std::string& n) {
    return std::any_of(others.begin(), others.end(), [&](const auto& o) { return o.name == n; });
  };
  std::string unique = name;
  for (int k = 2; taken(unique); ++k) unique = name + " (" + std::to_string(k) + ")";
  return unique;
}

// Motion together; what other sensors read is of each drive alone.
DiagnosisRun of_several(const DiagnosisRequest& request,
                        const DiagnosisOptions& options,
                        Console& console) {
  if (!request.map.empty())
    throw InvalidOption("--map", request.map.string(), "no map where there are several drives");
  std::vector<std::filesystem::path> folders{request.drive};
  folders.insert(folders.end(), request.more.begin(), request.more.end());
  std::vector<SessionStreams> drives;
  std::vector<Diagnosis> readings;
  DiagnosisRun run;
  Sha256 digest;
  for (const auto& folder : folders) {
    const Drive drive = Drive::open(folder);
    console.warn(drive.warnings());
    digest.update(drive.digest());
    drives.push_back({unique_name(drive.name(), drives), motion_streams(drive)});
    const std::string& name = drives.back().name;
    run.name += (run.name.empty() ? "" : ", ") + name;
    readings.push_back(diagnose_readings(drive_readings(drive, drives.back().streams.poses),
                                         options.search, options.library));
    mark_session(name, readings.back());
  }
  run.diagnosis = diagnose_sessions(drives, options);
  for (const Diagnosis& one : readings) add_findings(one, run.diagnosis);
  run.digest = digest.hex();
  return run;
}

}  // namespace

DiagnosisRun run_diagnosis(const DiagnosisRequest& request, Console& console) {
  DiagnosisOptions options;
  options.known = request.known;
  options.library.without = request.without;
  options.search.progress = console.progress();
  if (!request.more.empty()) return of_several(request, options, console);
  return std::filesystem::is_regular_file(request.drive) ? of_log(request, options)
                                                         : of_drive(request, options, console);
}

}  // namespace roadbook
