#include "workflows/diagnosis/several_drives.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "base/digest.hpp"
#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/sessions_diagnosis.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {
namespace {

struct NamedDrive {
  std::string name;  ///< unique name in reports
  Drive drive;
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

std::vector<NamedDrive> open_drives(const std::vector<std::filesystem::path>& folders,
                                    Messages& messages) {
  std::vector<NamedDrive> drives;
  std::map<std::string, std::filesystem::path> known;
  for (const auto& folder : folders) {
    if (std::filesystem::is_regular_file(folder))
      throw BadInput({Severity::kError, folder.string(), 0, "drive", "a file",
                      "the folder of a drive: plain logs are diagnosed one by one"});
    Drive drive = Drive::open(folder);
    const auto [first, fresh] = known.try_emplace(drive.digest(), folder);
    if (!fresh)
      throw BadInput({Severity::kError, folder.string(), 0, "drive",
                      "the same drive as " + first->second.string(), "another one"});
    messages.warn(drive.warnings());
    std::string name = unique_name(drive.name(), drives);
    drives.push_back({std::move(name), std::move(drive)});
  }
  return drives;
}

// Diagnoses the motion effects that the drives share. Leaves out a drive that has other readings
// but no recorded motion.
Diagnosis shared_motion(const std::vector<NamedDrive>& drives,
                        const std::vector<MotionStreams>& streams,
                        const std::vector<DriveReadings>& readings,
                        const DiagnosisOptions& options) {
  std::vector<SessionStreams> moving;
  std::vector<std::string> notes;
  for (std::size_t d = 0; d < drives.size(); ++d) {
    const bool stands_apart =
        !records_motion(streams[d]) && !readings[d].empty() && streams[d].poses.size() > 1;
    if (stands_apart)
      notes.push_back(drives[d].name +
                      ": left out of the motion, because it records no stream besides the poses");
    else
      moving.push_back({drives[d].name, streams[d], drives[d].drive.folder().string()});
  }
  Diagnosis all;
  if (!moving.empty()) all = diagnose_sessions(moving, options);
  if (moving.size() == 1) notes.push_back("motion: only " + moving.front().name + " records it");
  all.notes.insert(all.notes.begin(), notes.begin(), notes.end());
  return all;
}

}  // namespace

DiagnosisRun diagnose_several(const DiagnosisRequest& request,
                              const DiagnosisOptions& options,
                              Messages& messages) {
  if (!request.map.empty())
    throw InvalidOption("--map", request.map.string(), "no map with several drives");
  std::vector<std::filesystem::path> folders{request.drive};
  folders.insert(folders.end(), request.more.begin(), request.more.end());
  const std::vector<NamedDrive> drives = open_drives(folders, messages);
  std::vector<MotionStreams> streams;
  std::vector<DriveReadings> readings;
  DiagnosisRun run;
  Sha256 digest;
  for (const NamedDrive& one : drives) {
    digest.update(one.drive.digest());
    run.name += (run.name.empty() ? "" : ", ") + one.name;
    streams.push_back(motion_streams(one.drive));
    readings.push_back(drive_readings(one.drive, streams.back().poses, request.known));
  }
  run.digest = digest.hex();
  run.diagnosis = shared_motion(drives, streams, readings, options);
  std::vector<SessionReadings> read;
  for (std::size_t d = 0; d < drives.size(); ++d) read.push_back({drives[d].name, &readings[d]});
  add_findings(diagnose_readings(read, options.search, options.library, options.known),
               run.diagnosis);
  return run;
}

}  // namespace roadbook
