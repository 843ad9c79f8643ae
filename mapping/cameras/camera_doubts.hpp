#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "mapping/cameras/camera_fit.hpp"
#include "mapping/joined_tracks.hpp"

namespace roadbook {

// Cameras that contradict the motion which the whole rig found, with the parameter of the
// calibration that explains it best.

struct CameraDoubt {
  int session = 0;
  int camera = 0;
  std::string field;  ///< in the warning: "focal length", "images", ...
  std::string got;
  std::string want;
  std::vector<CameraErrors> errors =
      {};  ///< sizes of each parameter that is named, likeliest first
};

/// Evidence about one camera.
struct CameraEvidence {
  int session = 0;
  int camera = 0;
  std::vector<CameraTrack> tracks;
  double repeated_share = 0.0;  ///< of keyframes with exactly the corners before
  std::vector<CameraFit> fits;  ///< of each group of parameters
};

struct CameraDoubtOptions {
  double inlier_px = 0.6;         ///< of a track that fits, half-size image
  double rotation_rad = 0.009;    ///< sizes that matter, exceeded by one standard deviation
  double focal = 0.006;           ///< relative
  double centre_share = 0.012;    ///< of the focal length
  double position_m = 0.3;        ///< maps of right cameras bend and look like 0.1 to 0.24 m
  double delay_s = 0.012;         ///< right cameras show up to 14 ms +- 4 ms
  double min_sigmas = 4.0;        ///< a smaller effect may be chance
  double min_sigmas_weak = 6.0;   ///< of position and principal point
  double min_sigmas_delay = 3.0;  ///< of delays, which resemble no other parameter
  double min_gain = 0.002;        ///< share of the misfit that the effect explains
  double as_likely = 0.85;        ///< another parameter with this share of the gain is named too
  double of_largest = 0.6;        ///< other cameras' effects below this share of the largest follow
                                  ///< from it
  int num_threads = 0;
};

/// Of each camera of each session in turn. Deterministic on any number of threads.
[[nodiscard]] std::vector<CameraEvidence> camera_evidence(const MappingInput& input,
                                                          const KeyframeMotion& motion,
                                                          int num_threads);

/// What is likely wrong with the cameras: images that repeat, images of two cameras exchanged, the
/// parameter of a camera that explains its misfit best. One doubt a camera at most. Rigs of one
/// camera are not doubted, because nothing contradicts it. Deterministic.
[[nodiscard]] std::vector<CameraDoubt> doubt_cameras(
    const MappingInput& input,
    const std::vector<Eigen::Isometry3d>& T_map_vehicle,
    const CameraDoubtOptions& options = {});

/// The doubts as warnings about the cameras' folders.
[[nodiscard]] std::vector<Problem> to_problems(const std::vector<CameraDoubt>& doubts,
                                               const std::vector<Drive>& drives);

}  // namespace roadbook
