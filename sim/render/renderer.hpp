#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/camera.hpp"
#include "sim/world/world.hpp"

namespace roadbook {

// Ray casting of a world through any lens: one ray per pixel, textures filtered over the footprint
// of the pixel (at several points if it is long), more rays where surfaces meet.

/// The image behind the lens, before the image sensor.
struct View {
  cv::Mat brightness;  ///< 32-bit float, 0 to 255 as displayed, may exceed 255
  cv::Mat kind;        ///< 8 bit, SurfaceClass; empty if not wanted
  cv::Mat range_m;     ///< 32-bit float, distance from the camera's centre; 0: nothing hit
};

struct RenderOptions {
  bool kinds = false;
  bool ranges = false;
  bool own_car = true;    ///< the body of the measuring car hides the scene behind it
  bool antialias = true;  ///< more rays where surfaces meet
  int num_threads = 0;
};

class Renderer {
 public:
  /// Keeps references to `world`. Cameras are fixed to the car for the whole drive.
  Renderer(const World& world,
           std::vector<Camera> cameras,
           std::vector<Eigen::Isometry3d> T_vehicle_camera,
           const RenderOptions& options = {});
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Replaces all moving objects (world frame); they stay in place until the next call.
  void set_moving(const Mesh& mesh);

  /// The view of `camera` from the given poses: one for the whole image, or one a row (rolling
  /// shutter). The same for any number of threads.
  [[nodiscard]] View render(std::size_t camera,
                            const std::vector<Eigen::Isometry3d>& T_world_camera) const;

  /// Pixels hidden by the measuring car's own body: 255 hidden, 0 free.
  [[nodiscard]] const cv::Mat& own_car_mask(std::size_t camera) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
