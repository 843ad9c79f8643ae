#include "sim/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "sim/ray_scene.hpp"
#include "sim/shading.hpp"

namespace roadbook {
namespace {

constexpr std::uint32_t kNoSurface = 0xffffffffU;  // outside the lens
constexpr std::uint32_t kSkySurface = 0xfffffffeU;
constexpr std::uint32_t kMoving = 0x80000000U;  // flag: surfaces of things that move

/// What never changes about a camera. Rays lie by component, so that eight of a row are aimed and
/// cast at once.
struct Lens {
  int width = 0;
  int height = 0;
  float pixel_rad = 0.0F;
  std::array<std::vector<float>, 3> ray;  ///< by pixel, camera frame; zero outside the lens
  std::vector<int> sees;                  ///< by pixel: -1, or 0: nothing is seen past the own car
  cv::Mat hidden;                         ///< 8 bit: share of the pixel that the own car hides
  cv::Mat own_brightness;                 ///< 8 bit

  [[nodiscard]] Eigen::Vector3f at(std::size_t i) const {
    return {ray[0][i], ray[1][i], ray[2][i]};
  }
  [[nodiscard]] bool lit(std::size_t i) const {
    return ray[0][i] != 0.0F || ray[1][i] != 0.0F || ray[2][i] != 0.0F;
  }
};

Lens make_lens(const Camera& camera, int num_threads) {
  Lens lens;
  lens.width = camera.width;
  lens.height = camera.height;
  lens.pixel_rad = static_cast<float>(1.0 / camera.focal_px());
  const auto width = static_cast<std::size_t>(camera.width);
  const std::size_t pixels = width * static_cast<std::size_t>(camera.height);
  for (auto& component : lens.ray) component.assign(pixels + 8, 0.0F);
  lens.sees.assign(pixels + 8, 0);
  parallel_for(static_cast<std::size_t>(camera.height), num_threads, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto ray =
          camera.bearing(Eigen::Vector2d(static_cast<double>(x), static_cast<double>(y)));
      if (!ray) continue;
      for (std::size_t axis = 0; axis < 3; ++axis)
        lens.ray[axis][y * width + x] = static_cast<float>((*ray)[static_cast<Eigen::Index>(axis)]);
      lens.sees[y * width + x] = -1;
    }
  });
  lens.hidden = cv::Mat::zeros(lens.height, lens.width, CV_8UC1);
  lens.own_brightness = cv::Mat::zeros(lens.height, lens.width, CV_8UC1);
  return lens;
}

void prepare(RayPacket& packet) {
  RTCRay8& r = packet.rays.ray;
  for (std::size_t k = 0; k < 8; ++k) {
    r.tnear[k] = 0.02F;
    r.tfar[k] = std::numeric_limits<float>::infinity();
    r.time[k] = 0.0F;
    r.mask[k] = 0xffffffffU;
    r.flags[k] = 0;
    r.id[k] = static_cast<unsigned>(k);
    packet.rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

void set_ray(RayPacket& packet,
             std::size_t k,
             const Eigen::Vector3f& origin,
             const Eigen::Vector3f& direction) {
  RTCRay8& r = packet.rays.ray;
  r.org_x[k] = origin.x();
  r.org_y[k] = origin.y();
  r.org_z[k] = origin.z();
  r.dir_x[k] = direction.x();
  r.dir_y[k] = direction.y();
  r.dir_z[k] = direction.z();
  packet.valid[k] = -1;
}

struct RowPose {
  Eigen::Matrix3f R;
  Eigen::Vector3f origin;
};

/// Eight neighbouring rays of a row, from pixel i on.
void aim(const Lens& lens, std::size_t i, const RowPose& pose, RayPacket& packet) {
  const float* x = lens.ray[0].data() + i;
  const float* y = lens.ray[1].data() + i;
  const float* z = lens.ray[2].data() + i;
  const float* R = pose.R.data();  // column by column
  RTCRay8& r = packet.rays.ray;
  for (std::size_t k = 0; k < 8; ++k) {
    r.org_x[k] = pose.origin.x();
    r.org_y[k] = pose.origin.y();
    r.org_z[k] = pose.origin.z();
    r.dir_x[k] = R[0] * x[k] + R[3] * y[k] + R[6] * z[k];
    r.dir_y[k] = R[1] * x[k] + R[4] * y[k] + R[7] * z[k];
    r.dir_z[k] = R[2] * x[k] + R[5] * y[k] + R[8] * z[k];
  }
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

  /// Casts the packet and fills what its rays hit; returns surface ids through `surface`.
  void cast(RayPacket& packet,
            std::array<RayEnd, 8>& ends,
            std::array<std::uint32_t, 8>& surface) const {
    fixed.intersect(packet);
    std::array<bool, 8> is_moving{};
    if (!moving.empty()) {
      std::array<float, 8> before{};
      std::copy_n(packet.rays.ray.tfar, 8, before.begin());
      moving.intersect(packet);
      for (std::size_t k = 0; k < 8; ++k) is_moving[k] = packet.rays.ray.tfar[k] < before[k];
    }
    for (std::size_t k = 0; k < 8; ++k) {
      if (packet.valid[k] == 0) continue;
      const RTCRay8& r = packet.rays.ray;
      RayEnd& end = ends[k];
      end.origin = {r.org_x[k], r.org_y[k], r.org_z[k]};
      end.direction = {r.dir_x[k], r.dir_y[k], r.dir_z[k]};
      end.triangle = nullptr;
      surface[k] = kSkySurface;
      if (packet.rays.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      end.range_m = r.tfar[k];
      end.u = packet.rays.hit.u[k];
      end.v = packet.rays.hit.v[k];
      const RayScene& scene = is_moving[k] ? moving : fixed;
      end.triangle = &scene.triangle(packet.rays.hit.primID[k]);
      surface[k] = end.triangle->surface | (is_moving[k] ? kMoving : 0U);
    }
  }

  void trace_row(const Lens& lens,
                 const std::vector<RowPose>& rows,
                 int y,
                 View& view,
                 cv::Mat& surfaces) const;
  void refine_row(const Lens& lens,
                  const std::vector<RowPose>& rows,
                  int y,
                  View& view,
                  const cv::Mat& surfaces) const;
  void see_own_car(Lens& lens, const Eigen::Isometry3d& T_vehicle_camera) const;
};

/// First pass: one ray a pixel.
void Renderer::Impl::trace_row(const Lens& lens,
                               const std::vector<RowPose>& rows,
                               int y,
                               View& view,
                               cv::Mat& surfaces) const {
  RayPacket packet;
  std::array<RayEnd, 8> ends;
  std::array<std::uint32_t, 8> surface{};
  const RowPose& pose = rows[rows.size() == 1 ? 0 : static_cast<std::size_t>(y)];
  const auto width = static_cast<std::size_t>(lens.width);
  auto* brightness = view.brightness.ptr<float>(y);
  auto* surface_out = surfaces.ptr<int>(y);
  for (std::size_t x0 = 0; x0 < width; x0 += 8) {
    const std::size_t i0 = static_cast<std::size_t>(y) * width + x0;
    int any = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      packet.valid[k] = x0 + k < width ? lens.sees[i0 + k] : 0;
      any |= packet.valid[k];
    }
    if (any == 0) continue;
    prepare(packet);
    aim(lens, i0, pose, packet);
    cast(packet, ends, surface);
    for (std::size_t k = 0; k < 8; ++k) {
      if (packet.valid[k] == 0) continue;
      const auto x = static_cast<int>(x0 + k);
      brightness[x] = shader.shade(ends[k], lens.pixel_rad);
      surface_out[x] = static_cast<int>(surface[k]);
      if (options.kinds)
        view.kind.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(shader.kind(ends[k]));
      if (options.ranges && ends[k].triangle != nullptr)
        view.range_m.at<float>(y, x) = ends[k].range_m;
    }
  }
}

/// Second pass: four rays where a neighbour shows another surface.
void Renderer::Impl::refine_row(const Lens& lens,
                                const std::vector<RowPose>& rows,
                                int y,
                                View& view,
                                const cv::Mat& surfaces) const {
  static constexpr std::array<std::array<float, 2>, 4> kPlaces{
      {{-0.125F, -0.375F}, {0.375F, -0.125F}, {-0.375F, 0.125F}, {0.125F, 0.375F}}};
  if (y == 0 || y + 1 >= lens.height) return;
  const RowPose& pose = rows[rows.size() == 1 ? 0 : static_cast<std::size_t>(y)];
  const auto none = static_cast<int>(kNoSurface);
  std::array<int, 2> pixel{};
  std::size_t waiting = 0;
  RayPacket packet;
  packet.valid.fill(0);
  std::array<RayEnd, 8> ends;
  std::array<std::uint32_t, 8> surface{};
  const auto flush = [&] {
    for (std::size_t k = 4 * waiting; k < 8; ++k) packet.valid[k] = 0;
    cast(packet, ends, surface);
    for (std::size_t p = 0; p < waiting; ++p) {
      float sum = 0.0F;
      for (std::size_t k = 4 * p; k < 4 * p + 4; ++k)
        sum += std::min(255.0F, shader.shade(ends[k], 0.6F * lens.pixel_rad));
      view.brightness.at<float>(y, pixel[p]) = 0.25F * sum;
    }
    waiting = 0;
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
    if (waiting == 0) prepare(packet);
    const Eigen::Vector3f centre = pose.R * lens.at(i);
    const Eigen::Vector3f right = pose.R * (lens.at(i + 1) - lens.at(i));
    const Eigen::Vector3f down = pose.R * (lens.at(i + width) - lens.at(i));
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector3f ray = centre + kPlaces[k][0] * right + kPlaces[k][1] * down;
      set_ray(packet, 4 * waiting + k, pose.origin, ray);
    }
    pixel[waiting++] = x;
    if (waiting == 2) flush();
  }
  if (waiting > 0) flush();
}

/// The own body never moves before its cameras: seen once, 3 x 3 rays a pixel.
void Renderer::Impl::see_own_car(Lens& lens, const Eigen::Isometry3d& T_vehicle_camera) const {
  RayScene body;
  body.set(world.own_car.triangles);
  const Eigen::Matrix3f R = T_vehicle_camera.linear().cast<float>();
  const Eigen::Vector3f origin = T_vehicle_camera.translation().cast<float>();
  const auto width = static_cast<std::size_t>(lens.width);
  std::array<Eigen::Vector2f, 8> ring;  // eight places about the pixel's centre
  for (std::size_t k = 0; k < 8; ++k) {
    const float a = 0.785398F * static_cast<float>(k);
    ring[k] = {0.35F * std::cos(a), 0.35F * std::sin(a)};
  }
  parallel_for(
      static_cast<std::size_t>(std::max(0, lens.height - 1)), options.num_threads,
      [&](std::size_t y) {
        RayPacket packet;
        for (std::size_t x = 0; x + 1 < width; ++x) {
          const std::size_t i = y * width + x;
          if (!lens.lit(i) || !lens.lit(i + 1) || !lens.lit(i + width)) continue;
          prepare(packet);
          float sum = 0.0F;
          int hits = 0;
          for (std::size_t k = 0; k < 8; ++k) {
            const Eigen::Vector3f ray = lens.at(i) + ring[k].x() * (lens.at(i + 1) - lens.at(i)) +
                                        ring[k].y() * (lens.at(i + width) - lens.at(i));
            set_ray(packet, k, origin, R * ray.normalized());
          }
          body.intersect(packet);
          for (std::size_t k = 0; k < 8; ++k) {
            if (packet.rays.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
            RayEnd end{
                {packet.rays.ray.org_x[k], packet.rays.ray.org_y[k], packet.rays.ray.org_z[k]},
                {packet.rays.ray.dir_x[k], packet.rays.ray.dir_y[k], packet.rays.ray.dir_z[k]},
                packet.rays.ray.tfar[k],
                &body.triangle(packet.rays.hit.primID[k]),
                packet.rays.hit.u[k],
                packet.rays.hit.v[k]};
            sum += std::min(255.0F, shader.shade(end, lens.pixel_rad));
            ++hits;
          }
          if (hits == 0) continue;
          lens.hidden.at<std::uint8_t>(static_cast<int>(y), static_cast<int>(x)) =
              static_cast<std::uint8_t>(255 * hits / 8);
          if (hits == 8) lens.sees[i] = 0;
          lens.own_brightness.at<std::uint8_t>(static_cast<int>(y), static_cast<int>(x)) =
              static_cast<std::uint8_t>(sum / static_cast<float>(hits));
        }
      });
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
    if (options.own_car) impl_->see_own_car(impl_->lenses.back(), T_vehicle_camera[c]);
  }
}

Renderer::~Renderer() = default;

void Renderer::set_moving(const Mesh& mesh) { impl_->moving.set(mesh.triangles); }

const cv::Mat& Renderer::own_car_mask(std::size_t camera) const {
  return impl_->lenses[camera].hidden;
}

View Renderer::render(std::size_t camera,
                      const std::vector<Eigen::Isometry3d>& T_world_camera) const {
  const Lens& lens = impl_->lenses[camera];
  ROADBOOK_ASSERT(T_world_camera.size() == 1 ||
                  T_world_camera.size() == static_cast<std::size_t>(lens.height));
  std::vector<RowPose> rows;
  for (const auto& T : T_world_camera)
    rows.push_back({T.linear().cast<float>(), T.translation().cast<float>()});
  View view;
  view.brightness = cv::Mat::zeros(lens.height, lens.width, CV_32FC1);
  if (impl_->options.kinds) view.kind = cv::Mat::zeros(lens.height, lens.width, CV_8UC1);
  if (impl_->options.ranges) view.range_m = cv::Mat::zeros(lens.height, lens.width, CV_32FC1);
  cv::Mat surfaces(lens.height, lens.width, CV_32SC1, cv::Scalar(static_cast<int>(kNoSurface)));
  parallel_for(
      static_cast<std::size_t>(lens.height), impl_->options.num_threads,
      [&](std::size_t i) { impl_->trace_row(lens, rows, static_cast<int>(i), view, surfaces); });
  parallel_for(
      static_cast<std::size_t>(lens.height), impl_->options.num_threads, [&](std::size_t i) {
        const int y = static_cast<int>(i);
        if (impl_->options.antialias) impl_->refine_row(lens, rows, y, view, surfaces);
        if (!impl_->options.own_car) return;
        for (int x = 0; x < lens.width; ++x) {
          const std::uint8_t hidden = lens.hidden.at<std::uint8_t>(y, x);
          if (hidden == 0) continue;
          const float share = static_cast<float>(hidden) / 255.0F;
          float& value = view.brightness.at<float>(y, x);
          value += share * (static_cast<float>(lens.own_brightness.at<std::uint8_t>(y, x)) - value);
          if (hidden < 128) continue;
          if (impl_->options.kinds)
            view.kind.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(SurfaceClass::kOwnCar);
          if (impl_->options.ranges) view.range_m.at<float>(y, x) = 0.0F;
        }
      });
  return view;
}

}  // namespace roadbook
