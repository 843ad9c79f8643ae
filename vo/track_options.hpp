#pragma once

#include <Eigen/Core>

#include "sensors/rig.hpp"
#include "vo/features.hpp"
#include "vo/visual_odometry.hpp"

namespace roadbook {

struct TrackDriveOptions {
  FeatureOptions features;
  VoOptions odometry;
  double max_gap_s = 1.0;  ///< a longer time without images is a gap: its motion is unknown
  bool use_wheels = true;
  int num_threads = 0;  ///< 0: all cores

  /// Throws InvalidOption.
  void check() const;
};

// Features are detected in half-size images: a pixel of one is the mean of two by two pixels of the
// full image. Pixel coordinates name pixel centres.

/// Full-size pixels per half-size pixel.
inline constexpr double kFullPerHalfPixel = 2.0;
/// Coordinates in the full-size image of a pixel of the half-size image.
[[nodiscard]] Eigen::Vector2d full_size_pixel(const Eigen::Vector2d& half_size_pixel);
/// The rig with the cameras of half-size images.
[[nodiscard]] Rig half_size(const Rig& rig);

}  // namespace roadbook
