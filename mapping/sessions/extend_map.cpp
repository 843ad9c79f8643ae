#include "mapping/sessions/extend_map.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/localisation/landmark_index.hpp"
#include "mapping/pieces.hpp"
#include "mapping/pipeline/drive_steps.hpp"
#include "mapping/pipeline/map_gate.hpp"
#include "mapping/pipeline/map_inputs.hpp"
#include "mapping/pipeline/map_paths.hpp"
#include "mapping/pipeline/short_segments.hpp"
#include "mapping/pipeline/stage_clock.hpp"
#include "mapping/sessions/adjust_session.hpp"
#include "mapping/sessions/extended_map.hpp"
#include "mapping/sessions/join_session.hpp"
#include "mapping/sessions/place_session.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/wheel_scale_doubt.hpp"

namespace roadbook {
namespace {

// The sessions of a map keep the layers that refer to them by their index.
std::vector<std::string> tables_of_extension(const std::filesystem::path& file,
                                             const Map& map,
                                             const MapOptions& options,
                                             MapSummary& summary) {
  ExistingMap existing;
  existing.map.sessions = map.sessions;
  existing.stay = map.sessions.size();
  return tables_that_stay(file, existing, options.keep_tables, options.keep_tables_of_drives,
                          summary.warnings);
}

// Stores where the drive of the last session is now.
void renew_path(const Map& map, const Drive& drive, const std::filesystem::path& file) {
  std::vector<std::string> paths;
  for (const Session& session : map.sessions) paths.push_back(session.drive_path);
  const std::string path = path_from_map(drive.folder(), file);
  if (paths.back() == path) return;
  paths.back() = path;
  MapUpdate update(file);
  update.set_drive_paths(paths);
  update.commit();
}

void require_place(const PlacedSession& placed,
                   const GateInputs& inputs,
                   const MapOptions& options,
                   MapSummary& summary) {
  const std::size_t count = placed.keyframes.size();
  if (placed.joined < count && !options.gate.apart)
    throw Refused(to_line(
        {Severity::kError, inputs.map, 0, "sessions",
         inputs.drives.front() + " with " + std::to_string(placed.joined) + " of " +
             std::to_string(count) + " keyframes in the map",
         "a drive of its place (--apart keeps " +
             std::string(placed.joined == 0 ? "it as a map of its own)" : "the parts apart)")}));
  if (placed.other_pieces > 0)
    summary.warnings.push_back({Severity::kWarning, inputs.drives.front(), 0, "pieces",
                                std::to_string(placed.other_pieces) +
                                    " keyframes in a piece of the map that it would join",
                                "a map built again from all its drives (--batch)"});
}

// Truths of sessions whose drives are there; the others have none.
std::vector<DriveTruth> truths_of(const Map& map,
                                  const std::filesystem::path& map_path,
                                  const Drive& drive) {
  std::vector<DriveTruth> truths(map.sessions.size());
  truths.back() = truth_of_drive(drive);
  if (truths.back().poses.empty()) return truths;
  for (std::size_t s = 0; s + 1 < map.sessions.size(); ++s) {
    const auto folder = (map_path.parent_path() / map.sessions[s].drive_path).lexically_normal();
    if (!std::filesystem::is_directory(folder)) continue;
    try {
      const Drive earlier = Drive::open(folder);
      if (earlier.digest() == map.sessions[s].drive_digest) truths[s] = truth_of_drive(earlier);
    } catch (const BadInput&) {
      continue;  // its truth is missing in the summary, nothing else needs it
    }
  }
  return truths;
}

void extend_from(const std::vector<Drive>& drives,  // one
                 const std::filesystem::path& folder,
                 const std::filesystem::path& map_path,
                 const MapOptions& options,
                 const Progress& progress,
                 StageClock& clock,
                 MapSummary& summary) {
  const Drive& drive = drives.front();
  const MapHold hold(map_path);
  const Map map = clock.run("open map", [&] { return load_map_with_corners(map_path); });
  if (map.sessions.back().drive_digest == drive.digest() &&
      is_extended_by(map_path, drives, options)) {
    count_contents(map, summary);
    summary.is_unchanged = true;
    const MapMeta meta = load_meta(map_path);
    summary.digest = meta.digest;
    if (hold.waiting_build() == extension_of_build(meta)) hold.remove_checkpoints();
    renew_path(map, drive, map_path);
    return;
  }
  for (const Session& session : map.sessions)
    if (session.drive_digest == drive.digest())
      throw BadInput(
          {Severity::kError, folder.string(), 0, "drive",
           "session " + session.name + " of " + map_path.string() + ", added with other options",
           "a drive that the map lacks, or --batch to build the map again"});
  const std::string before = load_meta(map_path).digest;
  const std::string key = extension_checkpoint_key(before, drives, options);
  const auto keep_tables = tables_of_extension(map_path, map, options, summary);
  const auto names_before = layer_names(map_path);
  MapFileBuilder build(map_path, key);
  summary.warnings.insert(summary.warnings.end(), build.warnings().begin(), build.warnings().end());

  const OwnCar car = clock.run(
      "own car", [&] { return find_own_car(drive, options.vehicle, options.num_threads); });
  VoResult odometry =
      clock.run("odometry", [&] { return odometry_of(drive, car, 0, options, build, progress); });
  const int removed = remove_short_segments(odometry, options.min_keyframes);
  if (removed > 0) summary.warnings.push_back(short_segments_warning(drive, removed));
  add_doubts(drive, odometry, summary.warnings);
  const bool has_wheels = odometry.uses_wheels;
  std::vector<VoResult> of_drive;
  of_drive.push_back(std::move(odometry));
  MappingInput input = join_drives(std::move(of_drive), {drive.rig()}, {has_wheels});
  std::optional<double> ground_sigma;
  if (has_motion_without_wheels(input, 0))
    ground_sigma = clock.run("scale", [&] { return scale_by_ground(input, 0, options); });

  const GateInputs gate = gate_inputs({folder}, map_path);
  const PlacedSession placed = clock.run("localise", [&] {
    const LandmarkIndex index(map);
    return place_session(input, has_wheels || ground_sigma.has_value(), index, options, progress);
  });
  require_place(placed, gate, options, summary);
  const JoinedSession joined =
      clock.run("join", [&] { return join_session(map, input, placed, options); });
  Adjusted adjusted = clock.run("bundle adjustment",
                                [&] { return adjust_session(joined, map, options, progress); });

  const auto suspects = clock.run("cameras", [&] {
    const Adjusted alone = session_alone(joined, adjusted);
    return judge_cameras(input, drives, alone, gate, options, summary);
  });
  clock.run("covariances", [&] {
    add_covariances_of_session(joined, suspects, options, adjusted);
    return 0;
  });
  const Map extended = clock.run("assemble", [&] {
    const Session session = session_of(drive, car, options, map_path);
    return extended_map(map, session, joined, placed, adjusted, options,
                        has_wheels ? std::nullopt : ground_sigma);
  });
  if (auto doubt =
          doubt_of_wheel_scale(extended.sessions.back(), options.bundle.wheel_scale_sigma, folder))
    summary.warnings.push_back(std::move(*doubt));
  count_contents(extended, summary);
  add_reprojection(adjusted.result, summary);
  if (options.equal_rows) summary.rows = adjusted.rows;
  summary.localised_share = placed.localised_share();
  summary.drive_seconds =
      static_cast<double>(drive.frame_stamp_ns(drive.frame_count() - 1) - drive.frame_stamp_ns(0)) *
      1e-9;
  add_warnings_of(drives, summary);
  add_truth_errors(truths_of(extended, map_path, drive), extended, summary);
  clock.run("write", [&] {
    MapFinishOptions finish;
    finish.keep_tables = keep_tables;
    finish.keep_other_layers = options.adjust == SessionAdjust::kNone;
    if (options.more_layers) finish.layers = options.more_layers(extended);
    auto meta = extension_meta(map_path, drives, options);
    meta["gauge"] = gauge_of(options.adjust);
    if (summary.components > 1) meta[kPiecesKey] = std::to_string(summary.components);
    build.finish(extended, meta, finish);
    return 0;
  });
  add_dropped(names_before, map_path, summary);
}

}  // namespace

MapSummary extend_map(const std::filesystem::path& folder,
                      const std::filesystem::path& map_path,
                      const MapOptions& options,
                      const Progress& progress) {
  options.check();
  MapSummary summary;
  StageClock clock(summary.stages);
  const auto drives = clock.run("open", [&] { return open_drives({folder}, options.model); });
  try {
    extend_from(drives, folder, map_path, options, progress, clock, summary);
  } catch (const Refused& refusal) {
    add_warnings_of(drives, summary);
    throw with_warnings(refusal, summary.warnings);
  }
  return summary;
}

}  // namespace roadbook
