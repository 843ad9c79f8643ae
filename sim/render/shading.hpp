#pragma once

#include "sim/render/ray_scene.hpp"
#include "sim/render/shading_kernels.hpp"
#include "sim/world/world.hpp"

namespace roadbook {

/// Computes the brightness at the hits of rays. Keeps a reference to the world, and its constants
/// in single precision.
class Shader {
 public:
  explicit Shader(const World& world);

  /// Fills the brightness (0 to 255, may exceed) at the hits of rays of angular width `pixel_rad`.
  void shade(RayBatch& rays, float pixel_rad) const;
  /// Class of the surface that ray number `ray` hits.
  [[nodiscard]] SurfaceClass kind(const RayBatch& rays, std::size_t ray) const;

 private:
  void textured(RayBatch& rays, float pixel_rad) const;
  void move(const RayBatch& rays, GroundRays& ground) const;
  void painted(GroundRays& ground) const;
  void add_stones(GroundRays& ground) const;
  void add_gloss(GroundRays& ground) const;
  /// Brightness of the sky in `count` directions, as wide as `width_rad`.
  void sky(const Lane& dx,
           const Lane& dy,
           const Lane& dz,
           std::size_t count,
           float width_rad,
           Lane& value) const;

  const World& world_;
  const Texture* lamps_ = nullptr;  ///< null: the sky is above
  GroundPlan plan_;
  float rough_;
};

}  // namespace roadbook
