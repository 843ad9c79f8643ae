#include "apps/diagnosis_run.hpp"

#include <utility>

#include "base/digest.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/drive_streams.hpp"
#include "diagnosis/map_diagnosis.hpp"
#include "diagnosis/plain_log.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "drive/drive.hpp"
#include "mapping/map_file.hpp"

namespace roadbook {
namespace {

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
  const DriveReadings readings = drive_readings(drive, streams.poses);
  if (request.map.empty()) {
    run.diagnosis = diagnose_streams(streams, readings, request.drive.string(), options);
    return run;
  }
  const Map map = load_map(request.map);
  run.diagnosis = diagnose_through_map(map, session_of(map, drive, request.map), drive, options);
  add_findings(diagnose_readings(readings, options.search, options.library), run.diagnosis);
  return run;
}

}  // namespace

DiagnosisRun run_diagnosis(const DiagnosisRequest& request, Console& console) {
  DiagnosisOptions options;
  options.known = request.known;
  options.library.without = request.without;
  options.search.progress = console.progress();
  return std::filesystem::is_regular_file(request.drive) ? of_log(request, options)
                                                         : of_drive(request, options, console);
}

}  // namespace roadbook
