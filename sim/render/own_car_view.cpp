#include "sim/render/own_car_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/parallel.hpp"
#include "sim/render/ray_scene.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kRing = 8;  // rays about a pixel's centre
constexpr std::size_t kPixels = RayBatch::kMost / kRing;

struct BodyView {
  RayScene body;
  std::array<float, 9> R;
  std::array<float, 3> origin;
  std::array<Eigen::Vector2f, kRing> ring;
};

/// Marks the pixels of a row whose middle shows the body.
void find_body(const BodyView& view, const Lens& lens, std::size_t y, std::vector<char>& body) {
  const auto width = static_cast<std::size_t>(lens.width);
  RayBatch rays;
  rays.origin = view.origin;
  for (std::size_t x0 = 0; x0 < width; x0 += RayBatch::kMost) {
    rays.count = std::min(RayBatch::kMost, width - x0);
    for (std::size_t k = 0; k < rays.count; ++k) rays.set_direction(k, lens.at(y * width + x0 + k));
    turn(view.R, rays);
    rays.clear_ends();
    view.body.intersect(rays);
    for (std::size_t k = 0; k < rays.count; ++k)
      if (rays.triangle[k] != nullptr && lens.sees[y * width + x0 + k] != 0)
        body[y * width + x0 + k] = 1;
  }
}

/// Share and brightness of the body in the pixels collected.
void measure(const BodyView& view,
             const Shader& shader,
             const std::array<std::size_t, kPixels>& pixel,
             RayBatch& rays,
             Lens& lens) {
  turn(view.R, rays);
  rays.clear_ends();
  view.body.intersect(rays);
  shader.shade(rays, lens.pixel_rad);
  for (std::size_t p = 0; p < rays.count / kRing; ++p) {
    float sum = 0.0F;
    std::size_t hits = 0;
    for (std::size_t k = p * kRing; k < (p + 1) * kRing; ++k) {
      if (rays.triangle[k] == nullptr) continue;
      sum += std::min(255.0F, rays.brightness[k]);
      ++hits;
    }
    if (hits == 0) continue;
    lens.hidden.data[pixel[p]] = static_cast<std::uint8_t>(255 * hits / kRing);
    lens.own_brightness.data[pixel[p]] = static_cast<std::uint8_t>(sum / static_cast<float>(hits));
    if (hits == kRing) lens.sees[pixel[p]] = 0;
  }
  rays.count = 0;
}

void measure_row(const BodyView& view,
                 const Shader& shader,
                 const std::vector<char>& body,
                 std::size_t y,
                 Lens& lens) {
  const auto width = static_cast<std::size_t>(lens.width);
  RayBatch rays;
  rays.origin = view.origin;
  std::array<std::size_t, kPixels> pixel{};
  const std::size_t begin = y * width;
  for (std::size_t x = 0; x + 1 < width; ++x) {
    const std::size_t i = begin + x;
    const bool near = body[i] != 0 || body[i + 1] != 0 || body[i + width] != 0 ||
                      (x > 0 && body[i - 1] != 0) || (y > 0 && body[i - width] != 0);
    if (!near || !lens.lit(i) || !lens.lit(i + 1) || !lens.lit(i + width)) continue;
    pixel[rays.count / kRing] = i;
    const Eigen::Vector3f right = lens.at(i + 1) - lens.at(i);
    const Eigen::Vector3f down = lens.at(i + width) - lens.at(i);
    for (const Eigen::Vector2f& place : view.ring)
      rays.set_direction(rays.count++,
                         (lens.at(i) + place.x() * right + place.y() * down).normalized());
    if (rays.full()) measure(view, shader, pixel, rays, lens);
  }
  measure(view, shader, pixel, rays, lens);
}

}  // namespace

void see_own_car(const Mesh& own_car,
                 const Shader& shader,
                 const Eigen::Isometry3d& T_vehicle_camera,
                 int num_threads,
                 Lens& lens) {
  BodyView view;
  view.body.set(own_car.triangles);
  const Eigen::Matrix3f R = T_vehicle_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_vehicle_camera.translation().cast<float>();
  std::copy_n(R.data(), 9, view.R.begin());
  std::copy_n(origin.data(), 3, view.origin.begin());
  for (std::size_t k = 0; k < kRing; ++k) {
    const float a = 0.785398F * static_cast<float>(k);
    view.ring[k] = {0.35F * std::cos(a), 0.35F * std::sin(a)};
  }
  const auto rows = static_cast<std::size_t>(lens.height);
  std::vector<char> body(lens.sees.size(), 0);
  parallel_for(rows, num_threads, [&](std::size_t y) { find_body(view, lens, y, body); });
  parallel_for(rows - 1, num_threads,
               [&](std::size_t y) { measure_row(view, shader, body, y, lens); });
}

}  // namespace roadbook
