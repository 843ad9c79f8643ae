#include "workflows/diagnosis/several_drives.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "base/digest.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/sessions_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {
namespace {

// A drive or a plain log.
struct NamedDrive {
  std::string name;  ///< unique name in reports
  std::string source;
  std::string digest;
  MotionStreams streams;
  DriveReadings readings;
  std::vector<std::string> notes;
  std::vector<std::string> without;  ///< effects that its reference cannot have
};

// Returns a name that distinguishes the drive from the others in reports.
std::string unique_name(const std::string& name, const std::vector<NamedDrive>& others) {
  const auto taken = [&](const std::string& n) {
    return std::any_of(others.begin(), others.end(), [&](const auto& o) { return o.name == n; });
  };
  std::string unique = name;
  for (int k = 2; taken(unique); ++k) unique = name + " (" + std::to_string(k) + ")";
  return unique;
}

NamedDrive read_drive(const std::filesystem::path& folder,
                      const EffectSizes& known,
                      Messages& messages) {
  const Drive drive = Drive::open(folder);
  messages.warn(drive.warnings());
  MotionStreams streams = motion_streams(drive);
  DriveReadings readings = drive_readings(drive, streams.poses, known);
  return {drive.name(),
          drive.folder().string(),
          drive.digest(),
          std::move(streams),
          std::move(readings),
          {},
          {}};
}

NamedDrive read_log(const std::filesystem::path& description) {
  PlainLog log = read_plain_log(description);
  return {std::move(log.name),    description.string(),    std::move(log.digest),
          std::move(log.streams), std::move(log.readings), std::move(log.notes),
          std::move(log.without)};
}

std::vector<NamedDrive> open_drives(const std::vector<std::filesystem::path>& places,
                                    const EffectSizes& known_effects,
                                    Messages& messages) {
  std::vector<NamedDrive> drives;
  std::map<std::string, std::filesystem::path> known;
  for (const auto& place : places) {
    NamedDrive one = std::filesystem::is_regular_file(place)
                         ? read_log(place)
                         : read_drive(place, known_effects, messages);
    const auto [first, fresh] = known.try_emplace(one.digest, place);
    if (!fresh)
      throw BadInput({Severity::kError, place.string(), 0, "drive",
                      "the same drive as " + first->second.string(), "another one"});
    one.name = unique_name(one.name, drives);
    drives.push_back(std::move(one));
  }
  return drives;
}

// Diagnoses the motion effects that the drives share. Leaves out a drive that has other readings
// but no recorded motion.
Diagnosis shared_motion(const std::vector<NamedDrive>& drives, const DiagnosisOptions& options) {
  std::vector<SessionStreams> moving;
  std::vector<std::string> notes;
  for (const NamedDrive& one : drives) {
    const bool stands_apart =
        !records_motion(one.streams) && !one.readings.empty() && one.streams.poses.size() > 1;
    if (stands_apart)
      notes.push_back(one.name +
                      ": left out of the motion, because it records no stream besides the poses");
    else
      moving.push_back({one.name, one.streams, one.source});
    for (const std::string& note : one.notes) notes.push_back(one.name + ": " + note);
  }
  Diagnosis all;
  if (!moving.empty()) all = diagnose_sessions(moving, options);
  if (moving.size() == 1) notes.push_back("motion: only " + moving.front().name + " records it");
  all.notes.insert(all.notes.begin(), notes.begin(), notes.end());
  return all;
}

}  // namespace

DiagnosisRun diagnose_several(const DiagnosisRequest& request,
                              const DiagnosisOptions& given,
                              Messages& messages) {
  if (!request.map.empty())
    throw InvalidOption("--map", request.map.string(), "no map with several drives");
  std::vector<std::filesystem::path> places{request.drive};
  places.insert(places.end(), request.more.begin(), request.more.end());
  const std::vector<NamedDrive> drives = open_drives(places, request.known, messages);
  DiagnosisOptions options = given;
  DiagnosisRun run;
  Sha256 digest;
  const auto is_log = [](const std::filesystem::path& p) {
    return std::filesystem::is_regular_file(p);
  };
  if (std::all_of(places.begin(), places.end(), is_log))
    run.stated = StatedVehicle{drives.front().streams.wheel_model, true};
  for (const NamedDrive& one : drives) {
    digest.update(one.digest);
    run.name += (run.name.empty() ? "" : ", ") + one.name;
    auto& without = options.library.without;
    without.insert(without.end(), one.without.begin(), one.without.end());
  }
  run.digest = digest.hex();
  run.diagnosis = shared_motion(drives, options);
  for (const NamedDrive& one : drives)
    for (const std::string& effect : one.without)
      run.diagnosis.notes.push_back(effect + " is left out for all drives, because " + one.name +
                                    " cannot have it");
  std::vector<SessionReadings> read;
  for (const NamedDrive& one : drives) read.push_back({one.name, &one.readings});
  add_findings(diagnose_readings(read, options.search, options.library, options.known),
               run.diagnosis);
  return run;
}

}  // namespace roadbook
