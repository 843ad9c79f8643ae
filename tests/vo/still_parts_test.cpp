#include "vo/still_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/random.hpp"
#include "vo/own_car_mask.hpp"

namespace roadbook {
namespace {

constexpr int kStillWidth = 320;
constexpr int kStillHeight = 240;
constexpr int kHorizonRow = 110;

// A level pinhole that looks ahead; rows below the horizon see ground.
MountedCamera level_camera() {
  MountedCamera mounted;
  mounted.camera.width = kStillWidth;
  mounted.camera.height = kStillHeight;
  mounted.camera.parameters = {200.0, 200.0, 159.5, kHorizonRow, 0, 0, 0, 0, 0};
  mounted.T_vehicle_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  mounted.T_vehicle_camera.translation() = Eigen::Vector3d(1.4, 0.0, 1.3);
  return mounted;
}

struct StillScene {
  bool bonnet = true;
  bool moves = true;
  bool clouds = false;     // that stand above the horizon, as ahead of a straight road
  double exposure = 0.0;   // relative, how far it swings
  double bare_road = 0.0;  // 1: without texture
};

constexpr int kBonnetTop = 200;

// The bonnet: a bare shape with a dark rim along its upper edge.
bool is_bonnet(int u, int v) {
  return v >= kBonnetTop + static_cast<int>(0.002 * (u - 160) * (u - 160));
}

std::vector<cv::Mat> images_of(const StillScene& scene) {
  Random random(7, "scene");
  cv::Mat noise(kStillHeight * 4, kStillWidth * 4, CV_32F);
  for (int v = 0; v < noise.rows; ++v)
    for (int u = 0; u < noise.cols; ++u)
      noise.at<float>(v, u) = static_cast<float>(random.normal());
  cv::GaussianBlur(noise, noise, {}, 2.0);
  noise *= 30.0 / 0.14;  // standard deviation of about 30 levels
  std::vector<cv::Mat> images;
  for (int i = 0; i < 24; ++i) {
    const int du = scene.moves ? 37 * i % (3 * kStillWidth) : 0;
    const int dv = scene.moves ? 53 * i % (3 * kStillHeight) : 0;
    const double gain = 1.0 + scene.exposure * std::sin(1.7 * i);
    cv::Mat image(kStillHeight, kStillWidth, CV_8U);
    for (int v = 0; v < kStillHeight; ++v)
      for (int u = 0; u < kStillWidth; ++u) {
        double grey = 100.0 + noise.at<float>(v + dv, u + du) * (1.0 - scene.bare_road);
        if (v < kHorizonRow - 20) {
          grey = 210.0;
          if (scene.clouds) grey += 15.0 * std::sin(0.07 * u) * std::sin(0.09 * v + 1.0);
        }
        if (scene.bonnet && is_bonnet(u, v)) grey = is_bonnet(u, v - 6) ? 150.0 : 40.0;
        image.at<std::uint8_t>(v, u) =
            cv::saturate_cast<std::uint8_t>(gain * grey + 1.5 * random.normal());
      }
    images.push_back(image);
  }
  return images;
}

struct StillShares {
  double of_bonnet = 0.0;
  double of_rest = 0.0;
};

StillShares found_in(const StillScene& scene) {
  const cv::Mat found = find_still_parts(images_of(scene), level_camera());
  StillShares shares;
  if (found.empty()) return shares;
  double bonnet = 0.0;
  double rest = 0.0;
  for (int v = 0; v < kStillHeight; ++v)
    for (int u = 0; u < kStillWidth; ++u) {
      const bool is = is_bonnet(u, v);
      (is ? bonnet : rest) += 1.0;
      if (found.at<std::uint8_t>(v, u) != 0) (is ? shares.of_bonnet : shares.of_rest) += 1.0;
    }
  return {shares.of_bonnet / bonnet, shares.of_rest / rest};
}

TEST(StillParts, FindsABonnetWithoutTextureAndNoSky) {
  const StillShares shares = found_in({});
  EXPECT_GT(shares.of_bonnet, 0.98);
  EXPECT_LT(shares.of_rest, 0.05) << "the rim is blurred over some pixels";
}

TEST(StillParts, FindsItUnderASwingingExposure) {
  const StillShares shares = found_in({.exposure = 0.2});
  EXPECT_GT(shares.of_bonnet, 0.2) << "at least its rim";
  EXPECT_LT(shares.of_rest, 0.05);
}

TEST(StillParts, SkyAndBareRoadAreNotTheCar) {
  for (const double bare : {0.0, 0.8, 1.0})
    for (const bool clouds : {false, true}) {
      const StillShares shares = found_in({.bonnet = false, .clouds = clouds, .bare_road = bare});
      EXPECT_EQ(shares.of_rest + shares.of_bonnet, 0.0) << bare << (clouds ? " clouds" : "");
    }
}

// A mirror or a sign above the horizon: only what reaches the edge of the view can be of the car.
TEST(StillParts, AboveTheHorizonTheCarReachesTheEdgeOfTheView) {
  for (const int top : {0, 30}) {
    std::vector<cv::Mat> images = images_of({.bonnet = false});
    for (cv::Mat& image : images) image(cv::Rect(140, top, 40, 30)) = 20;
    const cv::Mat found = find_still_parts(images, level_camera());
    const bool is_found = !found.empty() && found.at<std::uint8_t>(top + 29, 160) != 0;
    EXPECT_EQ(is_found, top == 0);
  }
}

TEST(StillParts, ACarThatStandsTellsNothing) {
  EXPECT_TRUE(find_still_parts(images_of({.moves = false}), level_camera()).empty());
  EXPECT_TRUE(find_still_parts({}, level_camera()).empty());
}

// A bar of the car frames road of low contrast. The road changes by about 4 levels, more than a
// quarter of the scene's median, so it moves and only the bar may be masked.
TEST(StillParts, RoadSeenThroughAFrameOfTheCarIsNotTheCar) {
  const cv::Rect inside(100, 170, 120, 60);
  const cv::Rect bar(inside.x - 8, inside.y - 8, inside.width + 16, inside.height + 18);
  std::vector<cv::Mat> images = images_of({.bonnet = false, .bare_road = 0.87});
  for (cv::Mat& image : images) {
    const cv::Mat road = image(inside).clone();
    image(bar) = 20;
    road.copyTo(image(inside));
  }
  const cv::Mat found = find_still_parts(images, level_camera());
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.at<std::uint8_t>(inside.y - 4, inside.x + 60), 255);
  // The averaging reaches about 10 px over the bar's outline.
  const cv::Rect middle(inside.x + 14, inside.y + 14, inside.width - 28, inside.height - 28);
  EXPECT_EQ(cv::countNonZero(found(middle)), 0);
}

// 2,000 images. The last 100 show the car moving.
TEST(StillParts, FindsTheBonnetInADriveWithALongStop) {
  const std::vector<cv::Mat> moving = images_of({});
  constexpr std::size_t kCount = 2000;
  constexpr std::size_t kStart = 1900;
  const auto read = [&](std::size_t i) {
    return i < kStart ? moving[0] : moving[(i - kStart) * moving.size() / (kCount - kStart)];
  };
  const cv::Mat found = find_still_parts(spread_images(kCount, read), level_camera());
  ASSERT_FALSE(found.empty());
  EXPECT_GT(found.at<std::uint8_t>(kStillHeight - 5, kStillWidth / 2), 0);
  EXPECT_EQ(found.at<std::uint8_t>(kHorizonRow + 10, kStillWidth / 2), 0);
  EXPECT_EQ(spread_images(24, [&](std::size_t i) { return moving[i]; }).size(), 24U);
  EXPECT_TRUE(spread_images(1, read).empty());
}

// Both ways through the camera: points on the body's surface, projected, against pixels whose rays
// are followed to the body.
TEST(StillParts, TheBodysPixelsAreWhereItsSurfaceIsSeen) {
  MountedCamera mirror = level_camera();
  mirror.camera.model = CameraModel::kKannalaBrandt;
  mirror.camera.parameters = {100.0, 100.0, 159.5, 119.5, 0, 0, 0, 0, 0};
  mirror.camera.max_angle_rad = 1.65;
  // The camera looks to the left and down, from 10 cm outside the body.
  mirror.T_vehicle_camera.linear() = (Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitY()))
                                         .toRotationMatrix() *
                                     mirror.T_vehicle_camera.linear();
  mirror.T_vehicle_camera.translation() = Eigen::Vector3d(1.7, 0.98, 0.96);
  const Eigen::AlignedBox3d body(Eigen::Vector3d(-0.75, -0.88, 0.0),
                                 Eigen::Vector3d(3.45, 0.88, 1.46));
  const cv::Mat pixels = pixels_of_body(body, mirror.camera, mirror.T_vehicle_camera);
  cv::Mat drawn(kStillHeight, kStillWidth, CV_8U, cv::Scalar(0));
  for (double x = -0.75; x <= 3.45; x += 0.002)  // the only side that this camera can see
    for (double z = 0.0; z <= 1.46; z += 0.002) {
      const auto pixel =
          mirror.camera.project(mirror.T_vehicle_camera.inverse() * Eigen::Vector3d(x, 0.88, z));
      if (!pixel || !mirror.camera.contains(*pixel)) continue;
      drawn.at<std::uint8_t>(cvRound(pixel->y()), cvRound(pixel->x())) = 255;
    }
  ASSERT_GT(cv::countNonZero(drawn), 500);
  const cv::Mat near = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::Mat wider;
  cv::dilate(pixels, wider, near);
  EXPECT_EQ(cv::countNonZero(drawn & ~wider), 0);
  cv::dilate(drawn, wider, near);
  EXPECT_LT(cv::countNonZero(pixels & ~wider), 0.02 * cv::countNonZero(pixels));
  mirror.T_vehicle_camera.translation() = Eigen::Vector3d(1.7, 0.5, 1.6);
  EXPECT_EQ(cv::countNonZero(pixels_of_body(body, mirror.camera, mirror.T_vehicle_camera)), 0);
}

}  // namespace
}  // namespace roadbook
