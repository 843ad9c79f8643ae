#include "apps/evaluation/localisation/random_starts.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/se3.hpp"
#include "drive/true_poses.hpp"
#include "vo/odometry_run.hpp"
#include "workflows/localisation/localisation_figures.hpp"

namespace roadbook {
namespace {

constexpr double kInTimeM = 2.5;  // a pose is confirmed by 2 m of driving
constexpr double kGiveUpM = 6.0;
constexpr double kOffM = 0.3;
constexpr double kOffRad = 0.0349;  // 2 degrees

struct Start {
  std::size_t frame = 0;
  bool backwards = false;
};

struct Outcome {
  std::optional<LocalisedFrame> found;
  double driven_m = 0.0;
  double largest_ms = 0.0;
  double found_ms = 0.0;
};

PlanarMotion backwards(const PlanarMotion& motion) {
  PlanarMotion back = motion;
  const Eigen::Isometry3d T =
      pose_from_planar(motion.motion.x(), motion.motion.y(), motion.motion.z()).inverse();
  back.motion = {T.translation().x(), T.translation().y(), -motion.motion.z()};
  back.reversing = !motion.reversing;
  return back;
}

Outcome drive_from(const Start& start,
                   const Drive& drive,
                   const std::vector<cv::Mat>& masks,
                   const LandmarkIndex& index,
                   const WheelOdometry& wheels,
                   const TrackDriveOptions& tracking) {
  Localiser localiser(index, half_size(drive.rig()), {});
  localiser.prepare();
  Outcome outcome;
  std::size_t frame = start.frame;
  std::int64_t before_ns = drive.frame_stamp_ns(frame);
  std::int64_t clock_ns = 0;  // ascends also when the frames are taken backwards
  for (;;) {
    const std::int64_t t_ns = drive.frame_stamp_ns(frame);
    std::vector<double> cpu_ms;
    auto features = describe_frames(drive, {frame}, 0, 1, masks, tracking, &cpu_ms);
    const double start_ms = thread_cpu_ms();
    LocaliserFrame next;
    next.frame = frame;
    clock_ns += std::abs(t_ns - before_ns);
    next.t_ns = clock_ns;
    next.features = std::move(features.front());
    if (t_ns != before_ns) {
      next.wheels = wheels.between(std::min(before_ns, t_ns), std::max(before_ns, t_ns));
      if (next.wheels && t_ns < before_ns) next.wheels = backwards(*next.wheels);
      if (next.wheels) outcome.driven_m += next.wheels->distance_m;
    }
    LocalisedFrame pose = localiser.add(std::move(next));
    const double used_ms = cpu_ms.front() + thread_cpu_ms() - start_ms;
    outcome.largest_ms = std::max(outcome.largest_ms, used_ms);
    if (pose.tentative && outcome.found_ms == 0.0) outcome.found_ms = used_ms;
    if (localiser.confirmed()) {
      pose.frame = frame;
      outcome.found = std::move(pose);
      return outcome;
    }
    before_ns = t_ns;
    if (outcome.driven_m > kGiveUpM) return outcome;
    if (start.backwards ? frame == 0 : frame + 1 == drive.frame_count()) return outcome;
    frame = start.backwards ? frame - 1 : frame + 1;
  }
}

bool is_right(const LocalisedFrame& pose,
              const Drive& drive,
              const std::vector<TimedPose>& truth,
              const std::optional<Eigen::Isometry3d>& T_map_world) {
  if (!T_map_world) return false;
  const auto T_world_true = true_pose_at(truth, drive.frame_stamp_ns(pose.frame));
  if (!T_world_true) return false;
  const Eigen::Isometry3d off = (*T_map_world * *T_world_true).inverse() * pose.T_map_vehicle;
  return off.translation().norm() <= kOffM && so3_log(off.linear()).norm() <= kOffRad;
}

}  // namespace

StartTally random_starts(const Drive& drive,
                         const std::vector<cv::Mat>& masks,
                         const LandmarkIndex& index,
                         const std::optional<Eigen::Isometry3d>& T_map_world,
                         std::size_t starts,
                         std::uint64_t seed,
                         int num_threads,
                         const Progress& progress) {
  TrackDriveOptions tracking;
  tracking.num_threads = 1;
  const WheelOdometry wheels(drive.wheel_model().value_or(WheelModel{}), drive.wheel_readings());
  const auto truth = true_poses(drive);
  std::vector<Outcome> outcomes(starts);
  constexpr std::size_t kReported = 20;  // starts between two reports
  for (std::size_t begin = 0; begin < starts; begin += kReported) {
    const std::size_t count = std::min(kReported, starts - begin);
    parallel_for(count, num_threads, [&](std::size_t i) {
      Random random(seed, "random start", begin + i);
      // Not so near the ends that the car cannot drive on.
      const std::size_t margin = drive.frame_count() / 20;
      const Start start{margin + random.below(drive.frame_count() - 2 * margin),
                        random.uniform() < 0.5};
      outcomes[begin + i] = drive_from(start, drive, masks, index, wheels, tracking);
    });
    report(progress, "random starts", begin + count, starts);
  }
  StartTally tally;
  tally.starts = starts;
  for (const Outcome& outcome : outcomes) {
    tally.largest_try_ms = std::max(tally.largest_try_ms, outcome.largest_ms);
    if (!outcome.found) {
      ++tally.lost;
      continue;
    }
    tally.mean_try_ms += outcome.found_ms;
    if (!is_right(*outcome.found, drive, truth, T_map_world))
      ++tally.wrong;
    else
      ++(outcome.driven_m <= kInTimeM ? tally.right : tally.late);
  }
  if (tally.lost < starts) tally.mean_try_ms /= static_cast<double>(starts - tally.lost);
  return tally;
}

}  // namespace roadbook
