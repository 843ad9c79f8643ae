#include "sim/ray_scene.hpp"

#include "base/error.hpp"

namespace roadbook {

// One building thread: scenes are small, and the hierarchy is then always the same.
RayScene::RayScene() : device_(rtcNewDevice("threads=1")) { ROADBOOK_ASSERT(device_ != nullptr); }

RayScene::~RayScene() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void RayScene::set(const std::vector<Triangle>& triangles, bool lasting) {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  scene_ = nullptr;
  triangles_ = triangles;
  for (Triangle& t : triangles_) {
    t.normal = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]).normalized();
    if (t.texture == kGroundTexture && t.normal.z() < 0.0F) t.normal = -t.normal;
  }
  if (triangles_.empty()) return;
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  if (lasting) rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  const std::size_t n = triangles_.size();
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * n));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t vertex = 3 * i + k;
      for (std::size_t axis = 0; axis < 3; ++axis)
        vertices[3 * vertex + axis] = triangles_[i].corner[k][static_cast<Eigen::Index>(axis)];
      indices[vertex] = static_cast<unsigned>(vertex);
    }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

void RayScene::intersect(RayPacket& packet) const {
  if (scene_ == nullptr) return;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(packet.valid.data(), scene_, &context, &packet.rays);
}

}  // namespace roadbook
