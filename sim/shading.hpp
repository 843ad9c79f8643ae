#pragma once

#include <Eigen/Core>

#include "sim/world.hpp"

namespace roadbook {

/// A ray's end, ready to be coloured.
struct RayEnd {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;  ///< unit
  float range_m = 0.0F;
  const Triangle* triangle = nullptr;  ///< null: the sky
  float u = 0.0F;                      ///< barycentric
  float v = 0.0F;
};

/// Colours rays' ends. Keeps a reference to the world and its constants in single precision.
class Shader {
 public:
  explicit Shader(const World& world);

  /// Brightness (0 to 255, may exceed) of what a ray of angular width `pixel_rad` sees.
  [[nodiscard]] float shade(const RayEnd& end, float pixel_rad) const;
  /// What it sees.
  [[nodiscard]] SurfaceClass kind(const RayEnd& end) const;

 private:
  [[nodiscard]] float sky(const Eigen::Vector3f& d, float pixel_rad) const;
  [[nodiscard]] float ground(const RayEnd& end, float pixel_rad) const;
  [[nodiscard]] float painted(
      float x, float y, const Eigen::Vector3f& d, float narrow, float wide) const;
  [[nodiscard]] float mirrored(const Eigen::Vector3f& p,
                               const Eigen::Vector3f& d,
                               const Eigen::Vector3f& n) const;

  const World& world_;
  const Texture* lamps_ = nullptr;  ///< null: the sky is above
  float low_x_, low_y_, per_texel_, texel_;
  float width_, height_;  ///< of the painted ground, in texels
  float per_fine_, per_coarse_, rough_, glare_;
  float ceiling_z_, ceiling_x_, ceiling_y_, per_ceiling_texel_;
};

}  // namespace roadbook
