#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace roadbook {

/// Model of an image sensor: converts the brightness behind the lens to grey levels.
struct ImageSensorOptions {
  double gain = 1.0;          ///< exposure: factor on the light
  double vignetting = 0.0;    ///< relative loss of light at the edge of the image circle
  double read_noise = 0.8;    ///< [grey levels], in the dark
  double shot_noise = 0.085;  ///< [grey levels] per square root of a grey level
  bool noise = true;
};

/// Standard deviation [grey levels] of the noise at a grey level.
[[nodiscard]] double noise_sigma(double grey, const ImageSensorOptions& options);

/// Grey image of a view's brightness (32-bit float). Each (seed, frame, camera, row) has a separate
/// noise stream.
[[nodiscard]] cv::Mat develop(const cv::Mat& brightness,
                              const ImageSensorOptions& options,
                              std::uint64_t seed,
                              std::uint64_t frame,
                              std::uint64_t camera,
                              int num_threads);

}  // namespace roadbook
