#include "mapping/pipeline/build_map.hpp"

#include <algorithm>
#include <utility>

#include "drive/drive.hpp"
#include "mapping/cameras/camera_doubts.hpp"
#include "mapping/cameras/common_camera_errors.hpp"
#include "mapping/pieces.hpp"
#include "mapping/pipeline/checkpoint_blobs.hpp"
#include "mapping/pipeline/drive_steps.hpp"
#include "mapping/pipeline/map_gate.hpp"
#include "mapping/pipeline/map_inputs.hpp"
#include "mapping/pipeline/map_paths.hpp"
#include "mapping/pipeline/map_stages.hpp"
#include "mapping/pipeline/odometry_checkpoint.hpp"
#include "mapping/pipeline/scaled_relaxation.hpp"
#include "mapping/pipeline/short_segments.hpp"
#include "mapping/pipeline/stage_clock.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "mapping/store/map_file_lock.hpp"
#include "mapping/wheel_scale_doubt.hpp"
#include "vo/own_car_mask.hpp"

namespace roadbook {
namespace {

std::vector<LoopClosure> loops_of(const MappingInput& input,
                                  const MapOptions& options,
                                  MapFileBuilder& build,
                                  const Progress& progress) {
  if (build.has("loops")) return loops_from_blob(build.load("loops", "loops"));
  LoopOptions loop_options = options.loops;
  loop_options.num_threads = options.num_threads;
  auto loops = find_loops(input, loop_options, progress);
  build.save("loops", {{"loops", loops_to_blob(loops)}});
  return loops;
}

// Stores where the drives are now, if the map is right but for their paths on this machine.
void renew_drive_paths(const Map& map,
                       const std::vector<Drive>& drives,
                       const std::filesystem::path& file) {
  std::vector<std::string> paths;
  for (const Drive& drive : drives) paths.push_back(path_from_map(drive.folder(), file));
  if (std::equal(paths.begin(), paths.end(), map.sessions.begin(), map.sessions.end(),
                 [](const std::string& path, const Session& s) { return path == s.drive_path; }))
    return;
  MapUpdate update(file);
  update.set_drive_paths(paths);
  update.commit();
}

void fill_summary(const std::vector<Drive>& drives,
                  const Map& map,
                  const Adjusted& adjusted,
                  MapSummary& summary) {
  count_contents(map, summary);
  add_reprojection(adjusted.result, summary);
  for (const auto& drive : drives) {
    summary.drive_seconds += static_cast<double>(drive.frame_stamp_ns(drive.frame_count() - 1) -
                                                 drive.frame_stamp_ns(0)) *
                             1e-9;
  }
  add_warnings_of(drives, summary);
  std::vector<DriveTruth> truths;
  for (const Drive& drive : drives) truths.push_back(truth_of_drive(drive));
  add_truth_errors(truths, map, summary);
}

// Refuses drives whose parts do not hold together. The sensors that may be the cause become
// warnings.
void require_sound_graph(const std::vector<Drive>& drives,
                         const MappingInput& input,
                         const std::vector<LoopClosure>& loops,
                         const Relaxed& relaxed,
                         const GateInputs& gate,
                         const MapOptions& options,
                         MapSummary& summary) {
  try {
    require_joined(input, relaxed, gate, options.gate);
    require_loops(loops, gate, options.gate);
  } catch (const Refused&) {
    CameraDoubtOptions doubt;
    doubt.num_threads = options.num_threads;
    const auto doubts = to_problems(doubt_cameras(input, relaxed.T_map_vehicle, doubt), drives);
    summary.warnings.insert(summary.warnings.end(), doubts.begin(), doubts.end());
    throw;
  }
}

// The stages of build_map after the drives are open.
void build_from(const std::vector<Drive>& drives,
                const std::vector<std::filesystem::path>& folders,
                const std::filesystem::path& map_path,
                const MapOptions& options,
                const Progress& progress,
                StageClock& clock,
                MapSummary& summary) {
  const MapHold hold(map_path);
  const std::string key = checkpoint_key(drives, options);
  const auto existing = existing_map(map_path, drives, options);
  if (existing && !options.replace && is_built_from(*existing, map_path, drives, options)) {
    count_contents(existing->map, summary);
    summary.is_unchanged = true;
    summary.digest = load_meta(map_path).digest;
    if (hold.waiting_build() == key) hold.remove_checkpoints();  // killed after it was done
    renew_drive_paths(existing->map, drives, map_path);
    return;
  }
  std::vector<std::string> keep_tables;
  std::vector<std::string> names_before;
  if (existing) {
    keep_tables = tables_to_keep(*existing, map_path, drives, options, summary.warnings);
    names_before = layer_names(map_path);
  }
  MapFileBuilder build(map_path, key);
  summary.warnings.insert(summary.warnings.end(), build.warnings().begin(), build.warnings().end());

  const auto cars = clock.run("own car", [&] {
    std::vector<OwnCar> found;
    for (const auto& drive : drives)
      found.push_back(find_own_car(drive, options.vehicle, options.num_threads));
    return found;
  });
  std::vector<VoResult> odometry;
  std::vector<Rig> rigs;
  std::vector<bool> has_wheels;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    odometry.push_back(clock.run(
        "odometry", [&] { return odometry_of(drives[i], cars[i], i, options, build, progress); }));
    const int removed = remove_short_segments(odometry.back(), options.min_keyframes);
    if (removed > 0) summary.warnings.push_back(short_segments_warning(drives[i], removed));
    rigs.push_back(drives[i].rig());
    has_wheels.push_back(odometry.back().uses_wheels);
    add_doubts(drives[i], odometry.back(), summary.warnings);
  }
  MappingInput input = join_drives(std::move(odometry), rigs, has_wheels);
  std::vector<std::optional<double>> ground_sigma(drives.size());
  std::vector<LocalScale> heights;
  clock.run("scale", [&] {
    for (std::size_t i = 0; i < drives.size(); ++i) {
      const int session = static_cast<int>(i);
      if (!has_motion_without_wheels(input, session)) continue;
      if (has_wheels[i]) {
        (void)scale_by_ground(input, session, options);
        continue;
      }
      const SessionScale scale = scale_session(input, session, options);
      ground_sigma[i] = scale.sigma;
      heights.insert(heights.end(), scale.windows.begin(), scale.windows.end());
    }
    return 0;
  });
  auto loops = clock.run("loops", [&] { return loops_of(input, options, build, progress); });
  const auto relaxed = clock.run("pose graph", [&] {
    return std::find(has_wheels.begin(), has_wheels.end(), false) == has_wheels.end()
               ? relax_poses(input, loops, options, progress)
               : relax_scaled_poses(input, heights, loops, options, progress);
  });
  const GateInputs gate = gate_inputs(folders, map_path);
  require_sound_graph(drives, input, loops, relaxed, gate, options, summary);
  if (relaxed.components > 1)
    summary.warnings.push_back({Severity::kWarning, folders.front().string(), 0, "components",
                                std::to_string(relaxed.components) + " that no loop closure joins",
                                "1 (drive through places that two parts share)"});
  DescriptorMemory descriptors(build, options.descriptors_mb << 20U, input);
  auto adjusted = clock.run("bundle adjustment", [&] {
    AdjustTerms terms;
    terms.need_descriptors = [&](bool needed) { descriptors.need(needed); };
    return adjust(input, loops, relaxed, options, progress, terms);
  });
  for (LoopClosure& loop : loops) loop.matches = {};  // a map keeps none of them

  const auto suspects = clock.run("cameras", [&] {
    descriptors.need(true);
    return judge_cameras(input, drives, adjusted, gate, options, summary);
  });
  clock.run("covariances", [&] {
    descriptors.need(false);
    if (options.covariances)
      add_covariances(input, relaxed, common_errors_of(suspects, input, adjusted.stage), options,
                      adjusted);
    return 0;
  });

  const auto map = clock.run("assemble", [&] {
    descriptors.need(true);
    Map assembled = map_of_stages(input, loops, adjusted, options);
    for (std::size_t k = 0; k < assembled.keyframes.size(); ++k)
      assembled.keyframes[k].piece = relaxed.component[k];
    for (std::size_t i = 0; i < drives.size(); ++i) {
      Session session = session_of(drives[i], cars[i], options, map_path);
      set_scale(adjusted, i, ground_sigma[i], session);
      if (auto doubt = doubt_of_wheel_scale(session, options.bundle.wheel_scale_sigma, folders[i]))
        summary.warnings.push_back(std::move(*doubt));
      assembled.sessions.push_back(std::move(session));
    }
    return assembled;
  });
  fill_summary(drives, map, adjusted, summary);
  if (options.equal_rows) summary.rows = adjusted.rows;
  clock.run("write", [&] {
    MapFinishOptions finish;
    finish.keep_tables = keep_tables;
    finish.keep_other_layers = existing && has_same_poses(existing->map, map);
    if (options.more_layers) finish.layers = options.more_layers(map);
    auto meta = inputs_meta(drives, options);
    meta["gauge"] = "first keyframe of each piece fixed";
    if (summary.components > 1) meta[kPiecesKey] = std::to_string(summary.components);
    build.finish(map, meta, finish);
    return 0;
  });
  add_dropped(names_before, map_path, summary);
}

}  // namespace

MapSummary build_map(const std::vector<std::filesystem::path>& folders,
                     const std::filesystem::path& map_path,
                     const MapOptions& options,
                     const Progress& progress) {
  options.check();
  MapSummary summary;
  StageClock clock(summary.stages);
  const auto drives = clock.run("open", [&] { return open_drives(folders, options.model); });
  try {
    build_from(drives, folders, map_path, options, progress, clock, summary);
  } catch (const Refused& refusal) {
    add_warnings_of(drives, summary);
    throw with_warnings(refusal, summary.warnings);
  }
  return summary;
}

}  // namespace roadbook
