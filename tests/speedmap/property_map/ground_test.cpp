#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "base/se3.hpp"
#include "speedmap/property_map/ground_table.hpp"
#include "speedmap/property_map/ipm.hpp"
#include "tests/speedmap/small_property_map.hpp"

namespace roadbook {
namespace {

Camera camera_of(CameraModel model) {
  Camera camera;
  camera.model = model;
  camera.width = 640;
  camera.height = 400;
  if (model == CameraModel::kPinholeRadtan)
    camera.parameters = {300.0, 305.0, 320.0, 200.0, -0.05, 0.01, 1e-3, -1e-3};
  if (model == CameraModel::kKannalaBrandt)
    camera.parameters = {160.0, 162.0, 320.0, 200.0, 0.01, -0.004, 7e-4, -1e-4};
  if (model == CameraModel::kOmni)
    camera.parameters = {1.2, 350.0, 352.0, 320.0, 200.0, -0.05, 0.01, 1e-3, -1e-3};
  if (model == CameraModel::kDoubleSphere)
    camera.parameters = {-0.2, 0.55, 170.0, 171.0, 320.0, 200.0};
  return camera;
}

// Looking ahead and down.
Eigen::Isometry3d mounted(double pitch) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear().col(0) = -Eigen::Vector3d::UnitY();
  T.linear().col(1) = Eigen::Vector3d(-std::sin(pitch), 0.0, -std::cos(pitch));
  T.linear().col(2) = Eigen::Vector3d(std::cos(pitch), 0.0, -std::sin(pitch));
  T.translation() = Eigen::Vector3d(1.0, 0.2, 1.4);
  return T;
}

TEST(GroundPoint, ComesBackToWhereItWasProjectedFromForEveryCameraModel) {
  const GroundPlane tilted{{0.02, -0.03, 1.0}, {0.0, 0.0, 0.1}};
  Random random(1);
  for (const CameraModel model : {CameraModel::kPinholeRadtan, CameraModel::kKannalaBrandt,
                                  CameraModel::kOmni, CameraModel::kDoubleSphere}) {
    const Camera camera = camera_of(model);
    const Eigen::Isometry3d T = mounted(0.3);
    int seen = 0;
    for (int i = 0; i < 400; ++i) {
      Eigen::Vector3d p(random.uniform(2.5, 20.0), random.uniform(-4.0, 4.0), 0.0);
      p.z() = (tilted.normal.dot(tilted.point) - tilted.normal.head<2>().dot(p.head<2>())) /
              tilted.normal.z();
      const auto pixel = camera.project(T.inverse() * p);
      if (!pixel || !camera.contains(*pixel)) continue;
      const auto back = ground_point(camera, T, tilted, *pixel);
      ASSERT_TRUE(back);
      // The models' inverses are good to 1e-8 px; a pixel is at most 1 m of ground at 20 m.
      EXPECT_LT((*back - p).norm(), 2e-8);
      ++seen;

      const auto J = ground_jacobian(camera, T, tilted, p);
      ASSERT_TRUE(J);
      const double h = 1e-3;
      const auto right = ground_point(camera, T, tilted, *pixel + Eigen::Vector2d(h, 0.0));
      const auto left = ground_point(camera, T, tilted, *pixel - Eigen::Vector2d(h, 0.0));
      const Eigen::Vector3d difference = (*right - *left) / (2.0 * h);
      EXPECT_LT((J->col(0) - difference).norm(), 1e-4 * (1.0 + difference.norm()));
    }
    EXPECT_GT(seen, 100);
  }
}

TEST(GroundPoint, IsNoneAboveTheHorizonAndThePrintedFormulaMapsAllToTheOrigin) {
  const Camera camera = camera_of(CameraModel::kPinholeRadtan);
  EXPECT_FALSE(ground_point(camera, mounted(0.0), {}, {320.0, 100.0}));
  EXPECT_TRUE(ground_point(camera, mounted(0.0), {}, {320.0, 300.0}));
  const Eigen::Vector3d ray(0.1, 0.3, 1.0);
  EXPECT_EQ(literal_ground_point(ray, mounted(0.0), {}).norm(), 0.0);
}

// The reference tests every pixel separately.
TEST(GroundTable, CountsTheLabelsThatThePixelsGive) {
  const MountedCamera mounted_camera{"cam0", camera_of(CameraModel::kKannalaBrandt), mounted(0.3)};
  GroundTableOptions options;
  options.ahead_max_m = 15.0;
  options.aside_max_m = 5.0;
  const GroundTable table(mounted_camera, options);
  std::vector<std::uint8_t> image(640 * 400);
  Random random(2);
  for (auto& c : image) c = static_cast<std::uint8_t>(random.below(4));  // 3: no class
  std::vector<std::uint32_t> counts;
  const std::size_t left_out = table.count(image.data(), 640, 3, counts);
  std::size_t total = 0;
  for (const auto count : counts) total += count;
  EXPECT_EQ(total + left_out, table.pixels());
  EXPECT_NEAR(static_cast<double>(left_out), 0.25 * static_cast<double>(table.pixels()),
              4.0 * std::sqrt(0.19 * static_cast<double>(table.pixels())));
  std::size_t direct = 0;
  for (int v = 0; v < 400; ++v)
    for (int u = 0; u < 640; ++u) {
      const auto p = ground_point(mounted_camera.camera, mounted_camera.T_vehicle_camera, {},
                                  {static_cast<double>(u), static_cast<double>(v)});
      if (p && p->x() >= -60.0 && p->x() <= 15.0 && std::abs(p->y()) <= 5.0) ++direct;
    }
  EXPECT_EQ(direct, table.pixels());
  for (const Eigen::Vector2d& centre : table.centres()) EXPECT_LE(centre.x(), 15.0);
}

TEST(GroundTable, AFrameIsWorthItsGroundAndNotItsPixels) {
  const auto evidence = [](double scale, int frames, double travelled) {
    MountedCamera camera{"cam0", camera_of(CameraModel::kPinholeRadtan).scaled(scale),
                         mounted(0.5)};
    GroundTableOptions options;
    options.ahead_max_m = 12.0;
    options.aside_max_m = 3.0;
    const GroundTable table(camera, options);
    PropertyMap map = test::small_map({});
    const auto w = static_cast<std::size_t>(camera.camera.width);
    const std::vector<std::uint8_t> image(w * static_cast<std::size_t>(camera.camera.height), 1);
    std::vector<std::uint32_t> counts;
    table.count(image.data(), w, 3, counts);
    for (int i = 0; i < frames; ++i)
      add_frame(
          map, table, counts,
          [](const Eigen::Vector2d& p) {
            return PathPlace{p.x(), p.y()};
          },
          travelled);
    return map.evidence({6.0, 0.0});
  };
  const double once = evidence(1.0, 1, 1.0);
  // A square metre of ground is worth 0.6: the knots' interpolation evens out cells of 0.5 m.
  EXPECT_NEAR(once, 0.6, 0.06);
  EXPECT_NEAR(evidence(0.5, 1, 1.0), once, 0.06);
  EXPECT_NEAR(evidence(1.0, 4, 0.25), once, 1e-9);
}

}  // namespace
}  // namespace roadbook
