#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/ccalib/omnidir.hpp>
#include <vector>

#include "base/random.hpp"
#include "sensors/camera.hpp"
#include "sensors/camera_projections.hpp"

namespace roadbook {
namespace {

Camera kannala_brandt(const std::array<double, 4>& k) {
  Camera camera;
  camera.model = CameraModel::kKannalaBrandt;
  camera.parameters = {300.0, 310.0, 640.0, 480.0, k[0], k[1], k[2], k[3]};
  camera.width = 1280;
  camera.height = 960;
  return camera;
}

Eigen::Vector3d ray_at(double angle, double around) {
  return {std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), std::cos(angle)};
}

// r = theta - 0.3 theta^3 + 0.03 theta^5: the slope 1 - 0.9 t + 0.15 t^2 (t = theta^2) is 0 at
// t = 3 -+ sqrt(7/3); it is positive again beyond the second root.
TEST(CameraRange, EndsAtTheFirstAngleWhereTheRadiusCeasesToGrow) {
  const Camera camera = kannala_brandt({-0.3, 0.03, 0.0, 0.0});
  const double first = std::sqrt(3.0 - std::sqrt(7.0 / 3.0));
  const double second = std::sqrt(3.0 + std::sqrt(7.0 / 3.0));
  EXPECT_TRUE(camera.project(ray_at(first - 1e-6, 1.0)));
  EXPECT_FALSE(camera.project(ray_at(first + 1e-6, 1.0)));
  EXPECT_FALSE(camera.project(ray_at(0.5 * (first + second), 1.0)));
  EXPECT_FALSE(camera.project(ray_at(second + 0.1, 1.0)));
  EXPECT_FALSE(camera.project(ray_at(std::numbers::pi, 1.0)));
  Eigen::Vector2d pixel;
  EXPECT_FALSE(project_with<double>(camera.model, camera.parameters.data(),
                                    ray_at(second + 0.1, 1.0), &pixel));
  const double end = first * (1.0 - 0.3 * first * first + 0.03 * std::pow(first, 4));
  EXPECT_TRUE(camera.bearing({640.0 + 300.0 * (end - 1e-9), 480.0}));
  EXPECT_FALSE(camera.bearing({640.0 + 300.0 * (end + 1e-9), 480.0}));
}

// Judge: the radius itself, sampled every 0.2 mrad. Sampling sees no dip narrower than that, so
// angles within 2 mrad of the end that it finds are left out.
TEST(CameraRange, AgreesWithASlowSearchForAThousandPolynomials) {
  constexpr double kStep = 2e-4;
  int folded = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(5, "kannala-brandt", seed);
    std::array<double, 4> k{};
    for (std::size_t i = 0; i < 4; ++i)
      k[i] = random.normal() * 0.2 * std::pow(0.35, static_cast<double>(i));
    double end = 0.0;
    while (end < std::numbers::pi &&
           kannala_brandt_radius(k.data(), end + kStep) > kannala_brandt_radius(k.data(), end))
      end += kStep;
    folded += end < std::numbers::pi;
    const Camera camera = kannala_brandt(k);
    for (double angle = 0.01; angle < std::numbers::pi - 0.01; angle += 0.05) {
      if (std::abs(angle - end) < 2e-3) continue;
      const auto r = ray_at(angle, 0.4 + angle);
      const auto pixel = camera.project(r);
      ASSERT_EQ(pixel.has_value(), angle < end) << "seed " << seed << " angle " << angle;
      if (!pixel) continue;
      const auto back = camera.bearing(*pixel);
      ASSERT_TRUE(back) << "seed " << seed << " angle " << angle;
      // Near the fold an error of rounding in the radius is a larger one in the angle.
      EXPECT_LT((*back - r).norm(), 1e-10 / kannala_brandt_slope(k.data(), angle)) << seed;
    }
  }
  EXPECT_GT(folded, 200);
  EXPECT_LT(folded, 900);
}

// 1 + 3 k1 t + 5 k2 t^2 with k1 = -0.5, k2 = 0.1: 0 at t = 1 and t = 2, positive beyond.
TEST(CameraRange, OfRadialDistortionEndsAtTheFirstFoldToo) {
  Camera camera;
  camera.parameters = {500.0, 500.0, 320.0, 240.0, -0.5, 0.1, 0.0, 0.0};
  EXPECT_TRUE(camera.project({0.999, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({1.2, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({1.5, 0.0, 1.0}));
}

TEST(CameraRange, APointThatIsNoNumberHasNoPixel) {
  const double nan = std::nan("");
  for (const auto& p : {Eigen::Vector3d(nan, 0.0, 1.0), Eigen::Vector3d(0.1, 0.1, nan)})
    EXPECT_FALSE(kannala_brandt({0.0, 0.0, 0.0, 0.0}).project(p));
}

TEST(CameraRange, OmniAgreesWithOpenCvsOmnidir) {
  Camera camera;
  camera.model = CameraModel::kOmni;
  camera.parameters = {1.5, 800.0, 801.0, 640.0, 480.0, -0.05, 0.01, 1e-4, -2e-4};
  const auto& q = camera.parameters;
  std::vector<cv::Point3d> points;
  for (int i = 0; i <= 60; ++i) {
    const Eigen::Vector3d p = 4.0 * ray_at(1.7 * i / 60.0, 0.7 * i);
    points.emplace_back(p.x(), p.y(), p.z());
  }
  std::vector<cv::Point2d> pixels;
  const cv::Vec3d zero(0, 0, 0);
  cv::omnidir::projectPoints(points, pixels, zero, zero,
                             cv::Matx33d(q[1], 0, q[3], 0, q[2], q[4], 0, 0, 1), q[0],
                             cv::Vec4d(q[5], q[6], q[7], q[8]));
  ASSERT_EQ(pixels.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = camera.project({points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(pixel) << i;
    EXPECT_NEAR(pixel->x(), pixels[i].x, 1e-9);
    EXPECT_NEAR(pixel->y(), pixels[i].y, 1e-9);
  }
}

}  // namespace
}  // namespace roadbook
