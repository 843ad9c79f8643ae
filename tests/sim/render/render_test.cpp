#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "sim/render/image_sensor.hpp"
#include "sim/render/ray_scene.hpp"
#include "sim/render/renderer.hpp"
#include "sim/streams/rig.hpp"
#include "sim/world/surface_paint.hpp"

namespace roadbook {
namespace {

Scenario small_zurich() {
  ScenarioOptions options;
  options.size = "small";
  options.image_scale = 0.5;
  return load_scenario("zurich", options);
}

/// A plain plane with one white rectangle on black, nothing else.
struct Plate {
  World world;
  Rig rig;
  Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();

  /// The plate rises by `slope` a metre along x.
  explicit Plate(double slope = 0.0) {
    Scenario scenario = small_zurich();
    scenario.ground.low = {-15.0, -15.0};
    scenario.ground.high = {15.0, 15.0};
    scenario.ground.texel_m = 0.01;
    scenario.ground.roughness = 0.0;
    scenario.ground.glare = 0.0;
    world.scenario = scenario;
    scenario.ground.hinge = HingeSpec{{-15.0, -15.0}, {-15.0, 15.0}, slope};
    world.ground = Ground(scenario.ground, {-15.0 * slope, 0.0});
    world.paint.brightness = {cv::Mat::zeros(3000, 3000, CV_8UC1), scenario.ground.low, 0.01};
    world.paint.kind = {cv::Mat::ones(30, 30, CV_8UC1), scenario.ground.low, 1.0};
    rig = make_rig(CameraSpec{1280, 960, 12.5});
  }
  void finish() {
    world.ground_texture = Texture(world.paint.brightness.image, false);
    world.fine_stones = Texture(cv::Mat(4, 4, CV_8UC1, cv::Scalar(128)), true);
    world.coarse_stones = world.fine_stones;
    world.sky = Texture(cv::Mat(1024, 4096, CV_8UC1, cv::Scalar(200)), true);
    const std::array<Eigen::Vector2d, 3> none{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                              Eigen::Vector2d::Zero()};
    const auto lift = [&](double x, double y) {
      return Eigen::Vector3d(x, y, world.ground.height(x, y));
    };
    world.mesh.add_triangle({lift(-15, -15), lift(15, -15), lift(15, 15)}, none, kGroundTexture,
                            0.01, SurfaceClass::kRoad, 1.0, false);
    world.mesh.add_triangle({lift(-15, -15), lift(15, 15), lift(-15, 15)}, none, kGroundTexture,
                            0.01, SurfaceClass::kRoad, 1.0, true);
  }
  [[nodiscard]] View view(std::size_t camera, bool ranges) const {
    RenderOptions options;
    options.ranges = ranges;
    options.own_car = false;
    const Renderer renderer(world, {rig.cameras[camera].camera},
                            {rig.cameras[camera].T_vehicle_camera}, options);
    return renderer.render(0, {T_world_vehicle * rig.cameras[camera].T_vehicle_camera});
  }
};

TEST(Render, AMarkingLiesWhereTheCameraModelSaysItDoes) {
  Plate plate;
  // A disc's centre is compared through its weighted image centroid: small enough that the
  // projection is affine over it (6 cm at 2.5 m; the bias of a centroid is below 0.1 px there).
  const Eigen::Vector2d centre(6.0, 0.4);
  fill_convex(plate.world.paint.brightness, rectangle(centre, 0.3, {0.12, 0.12}), 255, 1.0);
  plate.finish();
  const View view = plate.view(0, false);
  const auto& mount = plate.rig.cameras[0];
  const auto expected = mount.camera.project(mount.T_vehicle_camera.inverse() *
                                             Eigen::Vector3d(centre.x(), centre.y(), 0.0));
  ASSERT_TRUE(expected.has_value());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  const int cx = static_cast<int>(expected->x()), cy = static_cast<int>(expected->y());
  for (int y = cy - 40; y <= cy + 40; ++y)
    for (int x = cx - 40; x <= cx + 40; ++x) {
      const double w = view.brightness.at<float>(y, x);
      sum += w * Eigen::Vector2d(x, y);
      weight += w;
    }
  ASSERT_GT(weight, 1000.0);
  EXPECT_LT((sum / weight - *expected).norm(), 0.3);
}

TEST(Render, WhatHasMovedLooksTheSameToACarThatMovedAsFar) {
  const Eigen::Vector2d shift(0.41, -0.23);
  const auto seen = [&](bool moved) {
    Plate plate;
    plate.world.scenario.ground.roughness = 0.8;
    fill_convex(plate.world.paint.brightness, rectangle({5.8, 0.3}, 0.3, {0.7, 0.2}), 255, 1.0);
    cv::add(plate.world.paint.brightness.image, 80, plate.world.paint.brightness.image);
    if (moved) {
      plate.world.moved = {{{4.0, -2.0}, {9.0, 2.0}, shift}};
      move_content(plate.world.moved, plate.world.paint.brightness);
      plate.T_world_vehicle.translation().head<2>() = shift;
    }
    plate.finish();
    cv::Mat stones(256, 256, CV_8UC1);
    cv::RNG random(7);
    random.fill(stones, cv::RNG::UNIFORM, 0, 256);
    plate.world.fine_stones = Texture(stones, true);
    plate.world.coarse_stones = Texture(stones, true);
    return plate.view(0, false).brightness;
  };
  const cv::Mat before = seen(false);
  const cv::Mat after = seen(true);
  const MountedCamera& mounted = Plate().rig.cameras[0];
  double stands = 0.0, moves = 0.0;
  int inside = 0, outside = 0;
  for (int y = 0; y < before.rows; y += 3)
    for (int x = 0; x < before.cols; x += 3) {
      const auto bearing = mounted.camera.bearing(Eigen::Vector2d(x, y));
      if (!bearing) continue;
      const Eigen::Vector3d ray = mounted.T_vehicle_camera.linear() * *bearing;
      const Eigen::Vector3d eye = mounted.T_vehicle_camera.translation();
      const Eigen::Vector3d p = eye - eye.z() / ray.z() * ray;
      if (ray.z() > -0.1 || std::abs(p.y()) > 4.0 || p.x() > 12.0) continue;
      const double change = std::abs(before.at<float>(y, x) - after.at<float>(y, x));
      if (p.x() > 4.7 && p.x() < 8.3 && std::abs(p.y()) < 1.5) {
        stands += change;
        ++inside;
      } else if (p.x() < 3.3) {
        moves += change;
        ++outside;
      }
    }
  ASSERT_GT(inside, 500);
  ASSERT_GT(outside, 500);
  EXPECT_LT(stands / inside, 1.0);   // rounding to texels
  EXPECT_GT(moves / outside, 10.0);  // the rest of the stones did not come along
}

TEST(Render, RangesAreThoseOfRayAndPlane) {
  Plate plate(0.02);
  plate.finish();
  for (const std::size_t c : {0U, 1U, 2U, 3U}) {
    const View view = plate.view(c, true);
    const auto& mount = plate.rig.cameras[c];
    const Eigen::Vector3d origin = mount.T_vehicle_camera.translation();
    const Eigen::Vector3d normal = Eigen::Vector3d(-0.02, 0.0, 1.0).normalized();
    int compared = 0;
    for (int y = 400; y < 960; y += 37)
      for (int x = 100; x < 1200; x += 41) {
        const auto ray = mount.camera.bearing(Eigen::Vector2d(x, y));
        if (!ray) continue;
        const Eigen::Vector3d d = mount.T_vehicle_camera.linear() * *ray;
        const double range = -normal.dot(origin) / normal.dot(d);
        const Eigen::Vector3d hit = origin + range * d;
        if (range <= 0.0 || hit.head<2>().cwiseAbs().maxCoeff() > 14.0) continue;
        // Single precision: 24 bits of coordinates up to 15 m, divided by the sine of incidence.
        EXPECT_NEAR(view.range_m.at<float>(y, x), range,
                    2e-5 * range / std::abs(normal.dot(d)) + 1e-5);
        ++compared;
      }
    EXPECT_GT(compared, 100);
  }
}

// The rays of a row of pixels seldom fill whole packets. What stands behind the last ray is not
// read, whatever it is.
TEST(Render, RaysAreCastWhateverStandsBehindTheLast) {
  Triangle floor;
  floor.uv.fill(Eigen::Vector2f::Zero());
  floor.corner = {Eigen::Vector3f(-50.0F, -50.0F, 0.0F), Eigen::Vector3f(50.0F, -50.0F, 0.0F),
                  Eigen::Vector3f(0.0F, 50.0F, 0.0F)};
  RayScene scene;
  scene.set({floor});
  for (const std::size_t count : {1U, 7U, 9U, 14U, 16U, 30U}) {
    SCOPED_TRACE(count);
    RayBatch rays{};
    for (auto* const part : {&rays.dx, &rays.dy, &rays.dz, &rays.range_m})
      part->fill(std::numeric_limits<float>::quiet_NaN());
    rays.origin = {0.0F, 0.0F, 2.0F};
    rays.count = count;
    rays.clear_ends();
    for (std::size_t i = 0; i < count; ++i) {
      const float angle = 0.02F * static_cast<float>(i);
      rays.set_direction(i, {std::sin(angle), 0.0F, -std::cos(angle)});
    }
    scene.intersect(rays);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_NE(rays.triangle[i], nullptr);
      EXPECT_NEAR(rays.range_m[i], 2.0F / std::cos(0.02F * static_cast<float>(i)), 1e-4F);
    }
  }
}

// Stones are drawn where a pixel shows less than 9 cm of the ground. Here they are all brighter
// than the ground around them, by a quarter.
TEST(Render, StonesAreSeenNearTheCarAndNotFarAway) {
  Plate plate;
  plate.world.paint.brightness.image.setTo(100);
  plate.world.scenario.ground.roughness = 0.5;
  plate.finish();
  plate.world.coarse_stones = Texture(cv::Mat(4, 4, CV_8UC1, cv::Scalar(192)), true);
  const View view = plate.view(0, false);
  const auto& mount = plate.rig.cameras[0];
  const auto brightness = [&](double ahead) {
    const auto pixel =
        mount.camera.project(mount.T_vehicle_camera.inverse() * Eigen::Vector3d(ahead, 0.0, 0.0));
    return view.brightness.at<float>(static_cast<int>(std::lround(pixel->y())),
                                     static_cast<int>(std::lround(pixel->x())));
  };
  EXPECT_NEAR(brightness(6.0) / brightness(14.5), 1.25, 0.02);
}

TEST(Render, TheSkyIsUp) {
  Plate plate;
  plate.finish();
  for (std::size_t c = 0; c < 4; ++c) {
    const View view = plate.view(c, false);
    EXPECT_EQ(view.brightness.at<float>(60, 640), 200.0F);
    EXPECT_LT(view.brightness.at<float>(900, 640), 100.0F);
  }
}

TEST(Render, ImageNoiseHasTheStatedSpread) {
  const ImageSensorOptions options;
  for (const float level : {20.0F, 120.0F, 220.0F}) {
    const cv::Mat flat(200, 200, CV_32FC1, cv::Scalar(level));
    const cv::Mat grey = develop(flat, options, 3, 0, 0, 1);
    cv::Scalar mean, spread;
    cv::meanStdDev(grey, mean, spread);
    const double sigma = noise_sigma(static_cast<double>(level), options);
    // 40000 samples: standard errors sigma / 200 and sigma / 283; rounding adds 1/12 of variance.
    EXPECT_NEAR(mean[0], static_cast<double>(level), 5.0 * sigma / 200.0 + 0.01);
    EXPECT_NEAR(spread[0], std::sqrt(sigma * sigma + 1.0 / 12.0), 5.0 * sigma / 283.0 + 0.01);
  }
}

TEST(Render, MarkingsEndWhereTheyAreSaidTo) {
  // Exact coverage: the painted area is that of the polygon, wherever it lies between the texels.
  for (const double shift : {0.0, 0.0031, 0.0077}) {
    Canvas canvas{cv::Mat::zeros(200, 200, CV_8UC1), Eigen::Vector2d::Zero(), 0.01};
    fill_convex(canvas, rectangle({1.0 + shift, 1.0 - shift}, 0.0, {0.5, 0.12}), 200, 1.0);
    const double area = cv::sum(canvas.image)[0] / 200.0 * 1e-4;
    EXPECT_NEAR(area, 0.5 * 0.12, 0.01 * 0.5 * 0.12);
  }
}

TEST(CameraEffects, TurnTheCameraToItsRight) {
  const Rig rig = make_rig({});
  const RealCamera real = real_camera(rig.cameras[0], {{"cam0.rotation", 0.02}});
  // What lies straight ahead of the turned camera lies to the right in the stated one.
  const Eigen::Vector3d ahead =
      rig.cameras[0].T_vehicle_camera.linear().transpose() * real.T_vehicle_camera.linear().col(2);
  EXPECT_NEAR(std::atan2(ahead.x(), ahead.z()), 0.02, 1e-12);
  EXPECT_EQ(real_camera(rig.cameras[1], {{"cam0.rotation", 0.02}}).T_vehicle_camera.matrix(),
            rig.cameras[1].T_vehicle_camera.matrix());
}

}  // namespace
}  // namespace roadbook
