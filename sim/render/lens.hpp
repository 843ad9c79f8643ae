#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/camera.hpp"

namespace roadbook {

/// The constant data of a camera: the ray of every pixel, and the pixels that the own car hides.
struct Lens {
  int width = 0;
  int height = 0;
  float pixel_rad = 0.0F;
  std::array<std::vector<float>, 3> ray;  ///< by pixel, camera frame; zero outside the lens
  std::vector<char> sees;  ///< by pixel: 0 outside the lens and where the own car hides all
  cv::Mat hidden;          ///< 8 bit: share of the pixel that the own car hides
  cv::Mat own_brightness;  ///< 8 bit

  [[nodiscard]] Eigen::Vector3f at(std::size_t i) const {
    return {ray[0][i], ray[1][i], ray[2][i]};
  }
  [[nodiscard]] bool lit(std::size_t i) const {
    return ray[0][i] != 0.0F || ray[1][i] != 0.0F || ray[2][i] != 0.0F;
  }
};

/// Without a car in front.
[[nodiscard]] Lens make_lens(const Camera& camera, int num_threads);

}  // namespace roadbook
