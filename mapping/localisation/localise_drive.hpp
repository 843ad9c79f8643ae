#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "drive/drive.hpp"
#include "mapping/localisation/localiser.hpp"
#include "vo/track_options.hpp"

namespace roadbook {

enum class LocalisedFrames {
  kAll,       ///< every instant with images
  kKeyframes  ///< at least a keyframe spacing apart, by the wheels; all without wheels
};

/// A start pose given by the user.
struct StartPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

struct LocaliseDriveOptions {
  TrackDriveOptions tracking;  ///< features, wheels and threads
  LocaliserOptions localiser;
  LocalisedFrames frames = LocalisedFrames::kAll;
  std::optional<StartPose> start;
};

struct TimedFrame {
  LocalisedFrame pose;  ///< without `views` and `in_view`
  double cpu_ms = 0.0;  ///< processor time of the frame: decoding, features, localisation
};

/// Localises all frames of a drive. Images are read and their features detected ahead, in parallel;
/// memory does not grow with the images. Frames before a confirmed pose without prediction get the
/// status kRelocalised. `masks`: one a camera, of the half-size images (`OwnCar`). The result,
/// without `cpu_ms`, does not depend on the number of threads. Throws BadInput for a drive without
/// cameras, InvalidOption, Interrupted.
[[nodiscard]] std::vector<TimedFrame> localise_drive(const Drive& drive,
                                                     const std::vector<cv::Mat>& masks,
                                                     const LandmarkIndex& index,
                                                     const LocaliseDriveOptions& options,
                                                     const Progress& progress = {});

}  // namespace roadbook
