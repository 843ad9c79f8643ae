#include "vo/track_drive.hpp"

#include <cstdlib>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "vo/odometry_run.hpp"
#include "vo/wheel_doubts.hpp"

namespace roadbook {

void TrackDriveOptions::check() const {
  features.check();
  odometry.check();
  if (!(max_gap_s > 0.0)) throw InvalidOption("max_gap_s", std::to_string(max_gap_s), "> 0");
}

Eigen::Vector2d full_size_pixel(const Eigen::Vector2d& half_size_pixel) {
  return kFullPerHalfPixel * half_size_pixel + Eigen::Vector2d::Constant(0.5);
}

Rig half_size(const Rig& rig) {
  Rig half = rig;
  for (auto& mounted : half.cameras)
    mounted.camera = mounted.camera.scaled(1.0 / kFullPerHalfPixel);
  return half;
}

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
  VoResult result = run_odometry(drive, masks, options, wheels ? &*wheels : nullptr, progress);
  if (wheels && std::getenv("RB_DBG") != nullptr) {
    double height = 0.0;
    for (const auto& mounted : drive.rig().cameras)
      height += mounted.T_vehicle_camera.translation().z();
    height /= static_cast<double>(drive.rig().cameras.size());
    (void)compare_wheels(result, *wheels, true);
    (void)ground_factor(result, height);
    const VoResult alone = run_odometry(drive, masks, options, nullptr, progress);
    (void)compare_wheels(alone, *wheels, false);
    (void)ground_factor(alone, height);
  }
  return result;
}

}  // namespace roadbook
