#include "workflows/diagnosis/diagnosis_run.hpp"

#include <cmath>
#include <utility>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/drive_session.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "diagnosis/streams/stated_wheelbase.hpp"
#include "drive/drive.hpp"
#include "mapping/pieces.hpp"
#include "mapping/session_track.hpp"
#include "mapping/store/map_file.hpp"
#include "workflows/diagnosis/localised_drive.hpp"
#include "workflows/diagnosis/several_drives.hpp"
#include "workflows/people/detections.hpp"

namespace roadbook {
namespace {

// Returns the people that `roadbook detect` stored in the map for the session, at the map's poses.
// Empty if it has not searched the session.
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

// Diagnoses the motion, if the drive records any, and the readings of the other sensors.
Diagnosis diagnose_streams(const MotionStreams& streams,
                           const DriveReadings& readings,
                           const std::string& name,
                           const DiagnosisOptions& options) {
  Diagnosis of_readings =
      diagnose_readings(readings, options.search, options.library, options.known);
  if (!records_motion(streams) && !readings.empty() && streams.poses.size() > 1) {
    of_readings.extended.insert(options.known.begin(), options.known.end());
    return of_readings;
  }
  Diagnosis all = diagnose(streams, name, options);
  add_findings(of_readings, all);
  return all;
}

DiagnosisRun of_log(const DiagnosisRequest& request, DiagnosisOptions options) {
  if (!request.map.empty())
    throw InvalidOption("--map", request.map.string(), "no map with a plain log");
  const PlainLog log = read_plain_log(request.drive);
  auto& without = options.library.without;
  without.insert(without.end(), log.without.begin(), log.without.end());
  DiagnosisRun run{diagnose_streams(log.streams, log.readings, request.drive.string(), options),
                   log.name, log.digest};
  run.diagnosis.notes.insert(run.diagnosis.notes.begin(), log.notes.begin(), log.notes.end());
  run.stated = StatedVehicle{log.streams.wheel_model, true};
  return run;
}

DiagnosisRun looked_into(const DiagnosisRequest& request,
                         const DiagnosisOptions& options,
                         Messages& messages,
                         const Drive& drive) {
  DiagnosisRun run{{}, drive.name(), drive.digest()};
  const MotionStreams streams = motion_streams(drive);
  run.stated = StatedVehicle{streams.wheel_model, false, drive.rig()};
  DriveReadings readings = drive_readings(drive, streams.poses, options.known);
  if (request.map.empty()) {
    run.diagnosis = diagnose_streams(streams, readings, request.drive.string(), options);
    return run;
  }
  const Map map = load_joined_map(request.map);
  if (const auto session = find_session(map, drive)) {
    run.diagnosis = diagnose_through_map(map, *session, drive, options);
    if (SightingReadings people = people_in_map(request.map, map, *session, drive);
        !people.looks.empty())
      readings.people = std::move(people);
  } else {
    const LocalisedDrive in_map =
        localised_drive(map, request.map, request.drive, options.num_threads, messages);
    run.diagnosis = diagnose_through_map(in_map.map, in_map.session, drive, options);
    run.diagnosis.notes.insert(run.diagnosis.notes.begin(),
                               "the drive is not part of the map: it was localised in the map");
  }
  add_findings(diagnose_readings(readings, options.search, options.library, options.known),
               run.diagnosis);
  return run;
}

DiagnosisRun of_drive(const DiagnosisRequest& request,
                      const DiagnosisOptions& options,
                      Messages& messages) {
  const Drive drive = Drive::open(request.drive);
  messages.warn(drive.warnings());
  DiagnosisRun run = looked_into(request, options, messages, drive);
  const auto wheelbase = unstated_wheelbase(drive);
  if (!wheelbase) return run;
  messages.warn({{Severity::kWarning, (request.drive / "wheels0" / "sensor.yaml").string(), 0,
                  "wheelbase", "nothing", "a length (that of a usual car is assumed)"}});
  run.diagnosis.notes.push_back(*wheelbase);
  return run;
}

}  // namespace

DiagnosisRun run_diagnosis(const DiagnosisRequest& request, int num_threads, Messages& messages) {
  if (request.compare && (!request.more.empty() || !request.map.empty()))
    throw InvalidOption("--compare", request.map.empty() ? "several drives" : "a map",
                        "one drive or log with a reference");
  DiagnosisOptions options;
  options.known = request.known;
  options.compare = request.compare;
  options.num_threads = num_threads;
  options.library.without = request.without;
  options.search.progress = messages.progress();
  if (!request.more.empty()) return diagnose_several(request, options, messages);
  return std::filesystem::is_regular_file(request.drive) ? of_log(request, options)
                                                         : of_drive(request, options, messages);
}

}  // namespace roadbook
