#include "vo/track_drive.hpp"

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "vo/odometry_run.hpp"
#include "vo/wheels/standstill.hpp"
#include "vo/wheels/wheel_doubts.hpp"
#include "vo/wheels/wheel_report.hpp"

namespace roadbook {

namespace {

double camera_height(const Rig& rig) {
  double sum = 0.0;
  for (const auto& mounted : rig.cameras) sum += mounted.T_vehicle_camera.translation().z();
  return sum / static_cast<double>(rig.cameras.size());
}

// Shares of the drive that the cameras alone must know to be asked about the wheels, and to work
// without them.
constexpr double kAskedShare = 0.5;
constexpr double kAloneShare = 0.8;

double share_known_by(const VoResult& sight, const Drive& drive, const WheelOdometry& wheels) {
  std::vector<std::int64_t> frames_ns;
  for (std::size_t i = 0; i < drive.frame_count(); ++i)
    frames_ns.push_back(drive.frame_stamp_ns(i));
  return known_share(sight, wheels, frames_ns);
}

// Odometry of a drive whose wheels may be wrong. It lets the cameras work alone first, and then
// leaves out the wheels where they contradict the cameras, or all of them. Cameras that lose their
// way alone cannot replace the wheels: then these stay in use, and the doubts are stated.
VoResult track_with_doubts(const Drive& drive,
                           const std::vector<cv::Mat>& masks,
                           const TrackDriveOptions& options,
                           WheelOdometry& wheels,
                           const Progress& progress) {
  const double height = camera_height(drive.rig());
  const auto alone = [&] { return run_odometry(drive, masks, options, nullptr, progress); };
  VoResult sight = alone();
  if (sight.keyframes.size() < 2) return run_odometry(drive, masks, options, &wheels, progress);
  const WheelComparison comparison = compare_wheels(sight, wheels, height);
  const std::int64_t origin_ns = drive.frame_stamp_ns(0);
  SensorDoubt all = describe_doubts(comparison, sight, origin_ns, true);
  const double known = share_known_by(sight, drive, wheels);
  if (known < kAloneShare) {
    VoResult result = run_odometry(drive, masks, options, &wheels, progress);
    if (known < kAskedShare || !comparison.doubts_all()) return result;
    all.want =
        "what the cameras see within 4 sigma; the cameras lose their way without the wheels, "
        "which stay in use";
    result.doubts.push_back(all);
    return result;
  }
  if (comparison.doubts_all()) {
    sight.doubts.push_back(all);
    return sight;
  }
  const SensorDoubt some = describe_doubts(comparison, sight, origin_ns, false);
  for (const WheelDoubt& doubt : comparison.doubts)
    wheels.distrust(doubt.span.first, doubt.span.second);
  sight = {};
  VoResult result = run_odometry(drive, masks, options, &wheels, progress);
  if (comparison.doubts.empty()) return result;
  if (!may_be_wrong(result, wheels, height)) {
    result.doubts.push_back(some);
    return result;
  }
  result = {};
  result = alone();
  result.doubts.push_back(all);
  return result;
}

}  // namespace

VoResult track_drive(const Drive& drive,
                     const std::vector<cv::Mat>& masks,
                     const TrackDriveOptions& options,
                     const Progress& progress) {
  options.check();
  if (drive.rig().cameras.empty())
    throw BadInput({Severity::kError, drive.folder().string(), 0, "cameras", "none",
                    "at least one camera to map with"});
  cv::setNumThreads(1);  // the images are already shared among our own threads
  std::optional<WheelOdometry> wheels;
  if (options.use_wheels && drive.wheel_model())
    wheels.emplace(*drive.wheel_model(), drive.wheel_readings());
  if (!wheels) return run_odometry(drive, masks, options, nullptr, progress);
  const auto standstills = false_standstills(drive, masks, options, *wheels);
  if (standstills.empty()) {
    VoResult result = run_odometry(drive, masks, options, &*wheels, progress);
    if (!may_be_wrong(result, *wheels, camera_height(drive.rig()))) return result;
  }
  return track_with_doubts(drive, masks, options, *wheels, progress);
}

}  // namespace roadbook
