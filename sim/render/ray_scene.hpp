#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/world/mesh.hpp"

namespace roadbook {

/// Rays from one origin, in the order of their pixels, and their hits. Stored component by
/// component for vector instructions.
struct RayBatch {
  static constexpr std::size_t kMost = 128;
  static constexpr std::size_t kPacket = 16;  ///< rays that Embree takes at once

  std::size_t count = 0;
  std::array<float, 3> origin{};
  alignas(64) std::array<float, kMost> dx, dy, dz;  ///< about unit
  alignas(64) std::array<float, kMost> range_m;
  alignas(64) std::array<float, kMost> u, v;  ///< barycentric
  alignas(64) std::array<float, kMost> brightness;
  std::array<const Triangle*, kMost> triangle;  ///< null: the sky

  [[nodiscard]] bool full() const { return count == kMost; }
  void set_direction(std::size_t i, const Eigen::Vector3f& d) {
    dx[i] = d.x();
    dy[i] = d.y();
    dz[i] = d.z();
  }
  /// Marks all rays as without a hit.
  void clear_ends();
};

/// A set of triangles that rays can be cast against. Embree behind it.
class RayScene {
 public:
  RayScene();
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Replaces the content. `lasting`: builds slower and casts faster. `flag` is set in the number
  /// of every surface.
  void set(const std::vector<Triangle>& triangles, bool lasting = false, std::uint32_t flag = 0);

  /// Updates the hits of rays that hit a triangle nearer than their current hit.
  void intersect(RayBatch& rays) const;

 private:
  RTCDevice device_;
  RTCScene scene_ = nullptr;
  std::vector<Triangle> triangles_;
};

}  // namespace roadbook
