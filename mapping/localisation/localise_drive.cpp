#include "mapping/localisation/localise_drive.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "vo/odometry_run.hpp"
#include "vo/wheels/false_times.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kAhead = 8;  // frames described while others are localised

std::optional<WheelOdometry> wheels_of(const Drive& drive, const TrackDriveOptions& options) {
  if (!options.use_wheels || !drive.wheel_model()) return std::nullopt;
  const auto readings = drive.wheel_readings();
  WheelOdometry wheels(*drive.wheel_model(), readings);
  if (wheels.empty()) return std::nullopt;
  for (const auto& [begin, end] : impossible_times(*drive.wheel_model(), readings))
    wheels.distrust(begin, end);
  return wheels;
}

// All frames, or one every `spacing_m` or `turn_rad` of the wheels.
std::vector<std::size_t> chosen_frames(const Drive& drive,
                                       const LocaliseDriveOptions& options,
                                       const std::optional<WheelOdometry>& wheels) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < drive.frame_count(); ++i) {
    if (options.frames == LocalisedFrames::kKeyframes && wheels && !frames.empty()) {
      const auto moved =
          wheels->between(drive.frame_stamp_ns(frames.back()), drive.frame_stamp_ns(i));
      if (moved && moved->motion.head<2>().norm() < options.tracking.odometry.spacing_m &&
          std::abs(moved->motion.z()) < options.tracking.odometry.turn_rad)
        continue;
    }
    frames.push_back(i);
  }
  return frames;
}

// The frames that waited for the confirmation have become right.
void confirm_tentative(std::vector<TimedFrame>& localised) {
  for (std::size_t i = localised.size(); i-- > 1;) {
    LocalisedFrame& before = localised[i - 1].pose;
    if (!before.tentative) return;
    before.tentative = false;
    before.status =
        before.inliers == 0 ? LocalisationStatus::kPredicted : LocalisationStatus::kRelocalised;
  }
}

}  // namespace

std::vector<TimedFrame> localise_drive(const Drive& drive,
                                       const std::vector<cv::Mat>& masks,
                                       const LandmarkIndex& index,
                                       const LocaliseDriveOptions& options,
                                       const Progress& progress) {
  options.tracking.check();
  if (drive.rig().cameras.empty())
    throw BadInput(
        {Severity::kError, drive.folder().string(), 0, "cameras", "none", "at least one camera"});
  const auto wheels = wheels_of(drive, options.tracking);
  const std::vector<std::size_t> frames = chosen_frames(drive, options, wheels);
  Localiser localiser(index, half_size(drive.rig()), options.localiser);
  if (options.start)
    localiser.start_near(options.start->x_m, options.start->y_m, options.start->heading_rad);
  struct Described {
    std::vector<FrameFeatures> features;
    std::vector<double> cpu_ms;
  };
  const auto describe_from = [&](std::size_t begin) {
    Described described;
    described.features =
        describe_frames(drive, frames, begin, kAhead, masks, options.tracking, &described.cpu_ms);
    return described;
  };
  std::vector<TimedFrame> localised;
  auto next = std::async(std::launch::async, describe_from, std::size_t{0});
  for (std::size_t begin = 0; begin < frames.size(); begin += kAhead) {
    Described now = next.get();
    if (begin + kAhead < frames.size())
      next = std::async(std::launch::async, describe_from, begin + kAhead);
    for (std::size_t i = 0; i < now.features.size(); ++i) {
      const double start_ms = thread_cpu_ms();
      LocaliserFrame frame;
      frame.frame = frames[begin + i];
      frame.t_ns = drive.frame_stamp_ns(frame.frame);
      frame.features = std::move(now.features[i]);
      if (wheels && begin + i > 0)
        frame.wheels = wheels->between(localised.back().pose.t_ns, frame.t_ns);
      TimedFrame timed{localiser.add(std::move(frame))};
      // Callers of `Localiser` get views and landmarks; those of a long drive would fill the
      // memory.
      timed.pose.views = {};
      timed.pose.in_view = {};
      timed.cpu_ms = now.cpu_ms[i] + thread_cpu_ms() - start_ms;
      localised.push_back(std::move(timed));
      if (localiser.confirmed()) confirm_tentative(localised);
    }
    report(progress, "localise", begin + now.features.size(), frames.size());
  }
  // Poses that driving never confirmed become lost.
  for (TimedFrame& one : localised) {
    if (!one.pose.tentative && one.pose.status != LocalisationStatus::kLost) continue;
    LocalisedFrame lost;
    lost.frame = one.pose.frame;
    lost.t_ns = one.pose.t_ns;
    one.pose = std::move(lost);
  }
  return localised;
}

}  // namespace roadbook
