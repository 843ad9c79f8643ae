#pragma once

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/mesh.hpp"

namespace roadbook {

/// Eight rays of a 4 x 2 tile (or any eight): origins, unit directions, and what they hit.
struct alignas(32) RayPacket {
  RTCRayHit8 rays;
  alignas(32) std::array<int, 8> valid;
};

/// A set of triangles that rays can be cast against. Embree behind it.
class RayScene {
 public:
  RayScene();
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Replaces the content. `lasting` takes longer to build and less to cast against.
  void set(const std::vector<Triangle>& triangles, bool lasting = false);
  [[nodiscard]] bool empty() const { return triangles_.empty(); }

  /// Nearest hits of the valid rays; shortens `tfar` and marks `geomID` with 0.
  void intersect(RayPacket& packet) const;
  [[nodiscard]] const Triangle& triangle(unsigned primitive) const { return triangles_[primitive]; }

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
  std::vector<Triangle> triangles_;
};

}  // namespace roadbook
