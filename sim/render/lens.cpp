#include "sim/render/lens.hpp"

#include "base/parallel.hpp"

namespace roadbook {

Lens make_lens(const Camera& camera, int num_threads) {
  Lens lens;
  lens.width = camera.width;
  lens.height = camera.height;
  lens.pixel_rad = static_cast<float>(1.0 / camera.focal_px());
  const auto width = static_cast<std::size_t>(camera.width);
  const std::size_t pixels = width * static_cast<std::size_t>(camera.height);
  for (auto& component : lens.ray) component.assign(pixels, 0.0F);
  lens.sees.assign(pixels, 0);
  parallel_for(static_cast<std::size_t>(camera.height), num_threads, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto ray =
          camera.bearing(Eigen::Vector2d(static_cast<double>(x), static_cast<double>(y)));
      if (!ray) continue;
      for (std::size_t axis = 0; axis < 3; ++axis)
        lens.ray[axis][y * width + x] = static_cast<float>((*ray)[static_cast<Eigen::Index>(axis)]);
      lens.sees[y * width + x] = 1;
    }
  });
  lens.hidden = cv::Mat::zeros(lens.height, lens.width, CV_8UC1);
  lens.own_brightness = cv::Mat::zeros(lens.height, lens.width, CV_8UC1);
  return lens;
}

}  // namespace roadbook
