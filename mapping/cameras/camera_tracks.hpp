#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/joined_tracks.hpp"

namespace roadbook {

// Corners of one camera followed by their descriptors alone. The tracks of visual odometry hold
// what agrees with the calibration; these also hold what contradicts it.

struct CameraView {
  int keyframe = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< half-size image
};

struct CameraTrack {
  int stretch = 0;                ///< of successive keyframes; their errors are not independent
  std::vector<CameraView> views;  ///< ascending keyframes, at least three
};

struct CameraTrackOptions {
  int stretches = 60;       ///< spread evenly over the drive
  int keyframes = 7;        ///< of a stretch
  std::size_t most = 1500;  ///< tracks, spread evenly over the stretches
  int max_hamming = 90;     ///< of 512 bits
  double max_ratio = 0.8;   ///< nearest over second-nearest descriptor distance
};

/// Tracks of a session's camera. Deterministic.
[[nodiscard]] std::vector<CameraTrack> follow_corners(const MappingInput& input,
                                                      int session,
                                                      int camera,
                                                      const CameraTrackOptions& options = {});

/// Share of the successive keyframes in which the camera shows exactly the same corners again; 0
/// without any to compare.
[[nodiscard]] double repeated_share(const MappingInput& input, int session, int camera);

}  // namespace roadbook
