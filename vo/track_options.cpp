#include "vo/track_options.hpp"

#include <string>

#include "base/error.hpp"

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

}  // namespace roadbook
