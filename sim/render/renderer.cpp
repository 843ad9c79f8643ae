#include "sim/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "sim/render/lens.hpp"
#include "sim/render/own_car_view.hpp"
#include "sim/render/ray_scene.hpp"
#include "sim/render/shading.hpp"

namespace roadbook {
namespace {

constexpr std::uint32_t kNoSurface = 0xffffffffU;  // outside the lens
constexpr std::uint32_t kSkySurface = 0xfffffffeU;
constexpr std::uint32_t kMoving = 0x80000000U;  // flag: surfaces of things that move

struct RowPose {
  std::array<float, 9> R;  ///< column by column
  std::array<float, 3> origin;
};

std::vector<RowPose> row_poses(const std::vector<Eigen::Isometry3d>& T_world_camera) {
  std::vector<RowPose> rows;
  for (const auto& T : T_world_camera) {
    const Eigen::Matrix3f R = T.linear().cast<float>();
    const Eigen::Vector3f origin = T.translation().cast<float>();
    std::copy_n(R.data(), 9, rows.emplace_back().R.begin());
    std::copy_n(origin.data(), 3, rows.back().origin.begin());
  }
  return rows;
}

}  // namespace

struct Renderer::Impl {
  const World& world;
  RenderOptions options;
  std::vector<Lens> lenses;
  RayScene fixed;
  RayScene moving;
  Shader shader;

  Impl(const World& w, const RenderOptions& o) : world(w), options(o), shader(w) {}

  /// Turns rays from the camera's frame, casts and colours them.
  void see(const RowPose& pose, float pixel_rad, RayBatch& rays) const {
    rays.origin = pose.origin;
    turn(pose.R, rays);
    rays.clear_ends();
    fixed.intersect(rays);
    moving.intersect(rays);
    shader.shade(rays, pixel_rad);
  }

  void trace_row(const Lens& lens, const RowPose& pose, int y, View& view, cv::Mat& surfaces) const;
  void refine_row(
      const Lens& lens, const RowPose& pose, int y, View& view, const cv::Mat& surfaces) const;
  void cover_row(const Lens& lens, int y, View& view) const;
};

/// First pass: one ray a pixel.
void Renderer::Impl::trace_row(
    const Lens& lens, const RowPose& pose, int y, View& view, cv::Mat& surfaces) const {
  RayBatch rays;
  std::array<int, RayBatch::kMost> pixel;
  auto* brightness = view.brightness.ptr<float>(y);
  auto* surface = surfaces.ptr<int>(y);
  const auto flush = [&] {
    see(pose, lens.pixel_rad, rays);
    for (std::size_t k = 0; k < rays.count; ++k) {
      const int x = pixel[k];
      const Triangle* triangle = rays.triangle[k];
      brightness[x] = rays.brightness[k];
      surface[x] = static_cast<int>(triangle == nullptr ? kSkySurface : triangle->surface);
      if (options.kinds)
        view.kind.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(shader.kind(rays, k));
      if (options.ranges && triangle != nullptr) view.range_m.at<float>(y, x) = rays.range_m[k];
    }
    rays.count = 0;
  };
  const std::size_t begin = static_cast<std::size_t>(y) * static_cast<std::size_t>(lens.width);
  for (int x = 0; x < lens.width; ++x) {
    const std::size_t i = begin + static_cast<std::size_t>(x);
    if (lens.sees[i] == 0) continue;
    pixel[rays.count] = x;
    rays.dx[rays.count] = lens.ray[0][i];
    rays.dy[rays.count] = lens.ray[1][i];
    rays.dz[rays.count++] = lens.ray[2][i];
    if (rays.full()) flush();
  }
  if (rays.count > 0) flush();
}

/// Second pass: four rays where a neighbour shows another surface.
void Renderer::Impl::refine_row(
    const Lens& lens, const RowPose& pose, int y, View& view, const cv::Mat& surfaces) const {
  static constexpr std::size_t kRays = 4;
  static constexpr std::array<std::array<float, 2>, kRays> kPlaces{
      {{-0.125F, -0.375F}, {0.375F, -0.125F}, {-0.375F, 0.125F}, {0.125F, 0.375F}}};
  if (y == 0 || y + 1 >= lens.height) return;
  const auto none = static_cast<int>(kNoSurface);
  RayBatch rays;
  std::array<int, RayBatch::kMost / kRays> pixel;
  const auto flush = [&] {
    see(pose, 0.6F * lens.pixel_rad, rays);
    for (std::size_t p = 0; p < rays.count / kRays; ++p) {
      float sum = 0.0F;
      for (std::size_t k = kRays * p; k < kRays * (p + 1); ++k)
        sum += std::min(255.0F, rays.brightness[k]);
      view.brightness.at<float>(y, pixel[p]) = sum / static_cast<float>(kRays);
    }
    rays.count = 0;
  };
  const auto* here = surfaces.ptr<int>(y);
  const auto* above = surfaces.ptr<int>(y - 1);
  const auto* below = surfaces.ptr<int>(y + 1);
  const auto width = static_cast<std::size_t>(lens.width);
  for (int x = 1; x + 1 < lens.width; ++x) {
    const int s = here[x];
    if (s == none || (here[x - 1] == s && here[x + 1] == s && above[x] == s && below[x] == s))
      continue;
    const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
    if (!lens.lit(i + 1) || !lens.lit(i + width)) continue;
    const Eigen::Vector3f right = lens.at(i + 1) - lens.at(i);
    const Eigen::Vector3f down = lens.at(i + width) - lens.at(i);
    pixel[rays.count / kRays] = x;
    for (const auto& place : kPlaces)
      rays.set_direction(rays.count++, lens.at(i) + place[0] * right + place[1] * down);
    if (rays.full()) flush();
  }
  if (rays.count > 0) flush();
}

/// Puts the own car in front.
void Renderer::Impl::cover_row(const Lens& lens, int y, View& view) const {
  const auto* hidden = lens.hidden.ptr<std::uint8_t>(y);
  const auto* own = lens.own_brightness.ptr<std::uint8_t>(y);
  auto* brightness = view.brightness.ptr<float>(y);
  for (int x = 0; x < lens.width; ++x) {
    if (hidden[x] == 0) continue;
    const float share = static_cast<float>(hidden[x]) / 255.0F;
    brightness[x] += share * (static_cast<float>(own[x]) - brightness[x]);
    if (hidden[x] < 128) continue;
    if (options.kinds)
      view.kind.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(SurfaceClass::kOwnCar);
    if (options.ranges) view.range_m.at<float>(y, x) = 0.0F;
  }
}

Renderer::Renderer(const World& world,
                   std::vector<Camera> cameras,
                   std::vector<Eigen::Isometry3d> T_vehicle_camera,
                   const RenderOptions& options)
    : impl_(std::make_unique<Impl>(world, options)) {
  ROADBOOK_ASSERT(cameras.size() == T_vehicle_camera.size());
  impl_->fixed.set(world.mesh.triangles, true);
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    impl_->lenses.push_back(make_lens(cameras[c], options.num_threads));
    if (options.own_car)
      see_own_car(world.own_car, impl_->shader, T_vehicle_camera[c], options.num_threads,
                  impl_->lenses.back());
  }
}

Renderer::~Renderer() = default;

void Renderer::set_moving(const Mesh& mesh) { impl_->moving.set(mesh.triangles, false, kMoving); }

const cv::Mat& Renderer::own_car_mask(std::size_t camera) const {
  return impl_->lenses[camera].hidden;
}

View Renderer::render(std::size_t camera,
                      const std::vector<Eigen::Isometry3d>& T_world_camera) const {
  const Lens& lens = impl_->lenses[camera];
  const RenderOptions& options = impl_->options;
  const auto height = static_cast<std::size_t>(lens.height);
  ROADBOOK_ASSERT(T_world_camera.size() == 1 || T_world_camera.size() == height);
  const std::vector<RowPose> poses = row_poses(T_world_camera);
  const auto pose = [&](std::size_t y) -> const RowPose& {
    return poses[poses.size() == 1 ? 0 : y];
  };
  View view;
  view.brightness = cv::Mat::zeros(lens.height, lens.width, CV_32FC1);
  if (options.kinds) view.kind = cv::Mat::zeros(lens.height, lens.width, CV_8UC1);
  if (options.ranges) view.range_m = cv::Mat::zeros(lens.height, lens.width, CV_32FC1);
  cv::Mat surfaces(lens.height, lens.width, CV_32SC1, cv::Scalar(static_cast<int>(kNoSurface)));
  parallel_for(height, options.num_threads, [&](std::size_t y) {
    impl_->trace_row(lens, pose(y), static_cast<int>(y), view, surfaces);
  });
  parallel_for(height, options.num_threads, [&](std::size_t y) {
    if (options.antialias) impl_->refine_row(lens, pose(y), static_cast<int>(y), view, surfaces);
    if (options.own_car) impl_->cover_row(lens, static_cast<int>(y), view);
  });
  return view;
}

}  // namespace roadbook
