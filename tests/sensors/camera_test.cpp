#include "sensors/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "sensors/camera_projections.hpp"

namespace roadbook {
namespace {

Camera make(CameraModel model, std::array<double, 9> q, double max_degrees) {
  Camera camera;
  camera.model = model;
  camera.parameters = q;
  camera.width = 1280;
  camera.height = 960;
  camera.max_angle_rad = max_degrees * std::numbers::pi / 180.0;
  return camera;
}

// Kannala-Brandt and double sphere of the TUM-VI rig (Kalibr, Basalt); the others are ordinary.
std::vector<Camera> cameras() {
  return {
      make(CameraModel::kPinholeRadtan,
           {458.6, 457.3, 367.2, 248.4, -0.283, 0.074, 0.00019, 1.76e-05}, 45.0),
      make(CameraModel::kKannalaBrandt,
           {190.978, 190.973, 254.93, 256.90, 0.0034824, 0.000715, -0.0020532, 0.00020294}, 95.0),
      make(CameraModel::kOmni, {1.5, 800.0, 801.0, 640.0, 480.0, -0.05, 0.01, 1e-4, -2e-4}, 95.0),
      make(CameraModel::kDoubleSphere, {-0.1721, 0.5931, 158.286, 158.274, 254.96, 256.89}, 95.0)};
}

Eigen::Vector3d ray(double angle, double around) {
  return {std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), std::cos(angle)};
}

template <typename Check>
void for_rays(Check check) {
  for (const Camera& camera : cameras()) {
    SCOPED_TRACE(camera_model_name(camera.model));
    for (int i = 0; i <= 40; ++i)
      for (int j = 0; j < 12; ++j)
        check(camera, ray(0.999 * camera.max_angle_rad * i / 40.0, 0.5 * j));
  }
}

TEST(Camera, BearingIsTheInverseOfProjectOverTheWholeView) {
  for_rays([](const Camera& camera, const Eigen::Vector3d& r) {
    const auto pixel = camera.project(3.0 * r);
    ASSERT_TRUE(pixel) << r.transpose();
    const auto back = camera.bearing(*pixel);
    ASSERT_TRUE(back) << r.transpose();
    EXPECT_LT((*back - r).norm(), 1e-8);
    EXPECT_LT((*camera.project(*back) - *pixel).norm(), 1e-8);
  });
}

// Central differences of step h err by h^2 f''' and by rounding / h: 1e-5 px/m is far above both.
TEST(Camera, JacobianIsThatOfFiniteDifferences) {
  for_rays([](const Camera& camera, const Eigen::Vector3d& r) {
    Matrix23d J;
    ASSERT_TRUE(camera.project(2.0 * r, &J));
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d step = Eigen::Vector3d::Zero();
      step[k] = 1e-5;
      Camera open = camera;
      open.max_angle_rad = 1.001 * camera.max_angle_rad;
      const auto a = open.project(2.0 * r + step);
      const auto b = open.project(2.0 * r - step);
      ASSERT_TRUE(a && b);
      EXPECT_LT(((*a - *b) / 2e-5 - J.col(k)).norm(), 1e-5 * (1.0 + J.norm()));
    }
  });
}

TEST(Camera, ProjectIsTheTemplatedFunctionThatCalibrationUses) {
  for_rays([](const Camera& camera, const Eigen::Vector3d& r) {
    Eigen::Vector2d pixel;
    ASSERT_TRUE(project_with<double>(camera.model, camera.parameters.data(), r, &pixel));
    EXPECT_LT((*camera.project(r) - pixel).norm(), 1e-9);
  });
}

TEST(Camera, AgreesWithOpenCV) {
  const auto all = cameras();
  for (const bool fisheye : {false, true}) {
    const Camera& camera = all[fisheye ? 1 : 0];
    const auto& q = camera.parameters;
    const cv::Matx33d K(q[0], 0, q[2], 0, q[1], q[3], 0, 0, 1);
    const cv::Vec4d D(q[4], q[5], q[6], q[7]);
    std::vector<cv::Point3d> points;
    for (int i = 1; i < 40; ++i) {
      const auto r = ray((fisheye ? 1.5 : 0.75) * i / 40.0, 0.7 * i);
      points.emplace_back(r.x(), r.y(), r.z());
    }
    std::vector<cv::Point2d> pixels;
    const cv::Vec3d zero(0, 0, 0);
    if (fisheye)
      cv::fisheye::projectPoints(points, pixels, zero, zero, K, D);
    else
      cv::projectPoints(points, zero, zero, K, D, pixels);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto pixel = camera.project({points[i].x, points[i].y, points[i].z});
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(pixel->x(), pixels[i].x, 1e-8);
      EXPECT_NEAR(pixel->y(), pixels[i].y, 1e-8);
    }
  }
}

// Two calibrations of one lens by two programs and models: they agree to half a degree up to 80.
TEST(Camera, TwoModelsOfTheSameLensSeeTheSameRays) {
  const auto all = cameras();
  for (int i = 0; i < 40; ++i) {
    const auto r = ray(1.4 * i / 40.0, 0.5 * i);
    const auto other = all[3].bearing(*all[1].project(r));
    ASSERT_TRUE(other);
    EXPECT_LT(std::acos(std::min(1.0, other->dot(r))), 0.5 * std::numbers::pi / 180.0);
  }
}

TEST(Camera, AnImageOfHalfTheSizeShowsTheSameRays) {
  for (const Camera& camera : cameras()) {
    const Camera half = camera.scaled(0.5);
    const auto pixel = camera.project(ray(0.5, 1.0));
    const auto small = half.project(ray(0.5, 1.0));
    ASSERT_TRUE(pixel && small);
    EXPECT_LT((2.0 * (small->array() + 0.5).matrix() - (pixel->array() + 0.5).matrix()).norm(),
              1e-9);
  }
}

// Where the view of a lens is straight ahead, a small angle times the focal length is its pixels.
TEST(Camera, TheFocalLengthIsPixelsByAngleInTheMiddleOfTheView) {
  constexpr double kAngle_rad = 1e-5;
  for (const Camera& camera : cameras()) {
    SCOPED_TRACE(camera_model_name(camera.model));
    const double pixels =
        (*camera.project(ray(kAngle_rad, 0.0)) - *camera.project(ray(0.0, 0.0))).norm();
    // The focal lengths of columns and rows differ by up to 0.3 %.
    EXPECT_NEAR(camera.focal_px() * kAngle_rad, pixels, 0.003 * pixels);
  }
}

}  // namespace
}  // namespace roadbook
