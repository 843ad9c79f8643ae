#include "apps/evaluation/robustness/alike_places.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "base/temporary_folder.hpp"
#include "drive/true_poses.hpp"
#include "sim/simulate.hpp"
#include "vo/own_car_mask.hpp"

namespace roadbook {
namespace {

constexpr double kWrongM = 0.5;
constexpr double kWrongRad = 0.1;
constexpr double kAlikeM = 0.35;    // between a keyframe and the equal place of another
constexpr double kAlikeRad = 0.15;  // between their directions

std::vector<Eigen::Vector3d> shifts_of(const Scenario& scenario) {
  std::vector<Eigen::Vector3d> shifts;
  if (scenario.ground.storeys)
    for (int up = 1; up < scenario.ground.storeys->count; ++up)
      for (const double sign : {-1.0, 1.0})
        shifts.emplace_back(0.0, 0.0, sign * up * scenario.ground.storeys->height_m);
  if (scenario.bays)
    for (int bay = 1; bay < scenario.bays->count; ++bay)
      for (const double sign : {-1.0, 1.0})
        shifts.emplace_back(sign * bay * scenario.bays->step_m(), 0.0, 0.0);
  return shifts;
}

bool was_verified(const LoopClosure& loop) {
  return loop.edge.accepted || loop.edge.reason.find("neighbouring") != std::string::npos ||
         loop.edge.reason.find("odometry") != std::string::npos;
}

template <typename Use>
LoopCount count_loops(const AlikeDrive& drive,
                      const std::vector<LoopClosure>& loops,
                      const Use& use) {
  LoopCount count;
  for (const LoopClosure& loop : loops) {
    if (!use(loop)) continue;
    ++count.all;
    count.wrong += is_wrong(drive, loop.edge) ? 1 : 0;
  }
  return count;
}

double largest_distance_m(const std::vector<Eigen::Isometry3d>& a,
                          const std::vector<Eigen::Isometry3d>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    largest = std::max(largest, (a[k].translation() - b[k].translation()).norm());
  return largest;
}

}  // namespace

AlikeDrive drive_alike_place(const AlikePlace& place,
                             std::uint64_t seed,
                             int num_threads,
                             const Progress& progress) {
  const TemporaryFolder folder;
  Scenario scenario =
      load_scenario(place.scenario, {.size = place.size, .image_scale = place.image_scale});
  scenario.seed += 1000 * seed;
  SimulateOptions options;
  options.seed = seed;
  options.num_threads = num_threads;
  simulate(scenario, folder.path() / "drive", options, progress);
  const Drive recorded = Drive::open(folder.path() / "drive");
  TrackDriveOptions tracking;
  tracking.num_threads = num_threads;
  std::vector<VoResult> odometry;
  odometry.push_back(
      track_drive(recorded, find_own_car(recorded, {}, num_threads).masks, tracking, progress));
  const bool has_wheels = odometry.front().uses_wheels;
  AlikeDrive drive;
  drive.input = join_drives(std::move(odometry), {recorded.rig()}, {has_wheels});
  std::map<std::int64_t, Eigen::Isometry3d> truth;
  for (const TimedPose& pose : true_poses(recorded)) truth.emplace(pose.t_ns, pose.T_world_vehicle);
  for (const VoKeyframe& keyframe : drive.input.odometry.keyframes)
    drive.T_world_vehicle.push_back(truth.at(keyframe.t_ns));
  drive.shifts = shifts_of(scenario);
  return drive;
}

bool is_wrong(const AlikeDrive& drive, const LoopEdge& edge) {
  const auto& truth = drive.T_world_vehicle;
  const Eigen::Isometry3d T = truth[static_cast<std::size_t>(edge.from)].inverse() *
                              truth[static_cast<std::size_t>(edge.to)];
  const Eigen::Isometry3d error = T.inverse() * edge.T_from_to;
  return error.translation().norm() > kWrongM || so3_log(error.linear()).norm() > kWrongRad;
}

std::vector<KeyframePair> alike_pairs(const AlikeDrive& drive, std::size_t count) {
  const auto& truth = drive.T_world_vehicle;
  std::vector<KeyframePair> all;
  for (std::size_t later = 0; later < truth.size(); ++later)
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      const Eigen::Isometry3d T = truth[earlier].inverse() * truth[later];
      if (so3_log(T.linear()).norm() > kAlikeRad) continue;
      const Eigen::Vector3d apart = truth[later].translation() - truth[earlier].translation();
      if (std::any_of(drive.shifts.begin(), drive.shifts.end(), [&](const Eigen::Vector3d& shift) {
            return (apart - shift).norm() < kAlikeM;
          }))
        all.push_back({static_cast<int>(earlier), static_cast<int>(later)});
    }
  if (all.size() <= count) return all;
  std::vector<KeyframePair> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(all[i * all.size() / count]);
  return chosen;
}

AlikeResult judge_loops(const AlikeDrive& drive,
                        int forced,
                        const MapOptions& options,
                        const Progress& progress) {
  LoopOptions loop_options = options.loops;
  loop_options.num_threads = options.num_threads;
  auto loops = find_loops(drive.input, loop_options, progress);
  AlikeResult result;
  if (forced > 0) {
    std::vector<KeyframePair> pairs = alike_pairs(drive, static_cast<std::size_t>(forced));
    result.forced = static_cast<int>(pairs.size());
    for (const LoopClosure& loop : loops) pairs.push_back({loop.edge.from, loop.edge.to});
    std::stable_sort(pairs.begin(), pairs.end(), [](const KeyframePair& a, const KeyframePair& b) {
      return a.later < b.later;
    });
    loops = verify_loops(drive.input, pairs, loop_options, progress);
  }
  result.candidates = static_cast<int>(loops.size());
  result.verified = count_loops(drive, loops, was_verified);
  const auto accepted = [](const LoopClosure& loop) { return loop.edge.accepted; };
  result.accepted = count_loops(drive, loops, accepted);
  std::vector<LoopClosure> right = loops;
  std::erase_if(right, [&](const LoopClosure& loop) { return is_wrong(drive, loop.edge); });
  const auto relaxed = relax_poses(drive.input, loops, options, progress);
  result.kept = count_loops(drive, loops, accepted);
  result.largest_bend_m = largest_distance_m(
      relaxed.T_map_vehicle, relax_poses(drive.input, right, options, progress).T_map_vehicle);
  return result;
}

}  // namespace roadbook
