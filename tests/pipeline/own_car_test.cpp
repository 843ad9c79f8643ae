#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "sim/render/image_sensor.hpp"
#include "sim/render/renderer.hpp"
#include "sim/streams/rig.hpp"
#include "sim/world/car_model.hpp"
#include "vo/own_car_mask.hpp"
#include "vo/still_parts.hpp"

namespace roadbook {
namespace {

struct Overlap {
  double found = 0.0;    // share of the car's pixels that the mask has
  double outside = 0.0;  // share of the image masked outside the car, without corners
};

Overlap overlap_of(const cv::Mat& mask, const cv::Mat& car, const Camera& camera) {
  double of_car = 0.0;
  double hit = 0.0;
  double beside = 0.0;
  for (int v = 0; v < car.rows; ++v)
    for (int u = 0; u < car.cols; ++u) {
      const auto ray = camera.bearing({u, v});
      if (!ray || !camera.project(*ray)) continue;
      const bool is_car = car.at<std::uint8_t>(v, u) != 0;
      const bool masked = !mask.empty() && mask.at<std::uint8_t>(v, u) != 0;
      of_car += is_car ? 1.0 : 0.0;
      hit += is_car && masked ? 1.0 : 0.0;
      beside += !is_car && masked ? 1.0 : 0.0;
    }
  return {hit / of_car, beside / static_cast<double>(car.total())};
}

// The simulator draws its own car as a mesh. The box of vehicle.yaml and the mask measured in the
// images must cover this mesh and little more.
TEST(OwnCar, BoxAndMeasuredMaskCoverTheRenderedCar) {
  ScenarioOptions options;
  options.size = "small";
  options.image_scale = 0.5;  // the scale at which the mask is measured
  const Scenario scenario = load_scenario("zurich", options);
  const World world = make_world(scenario, {}, 0);
  const Rig rig = make_rig(scenario.cameras);
  const auto body = vehicle_measures(scenario.vehicle).body();
  ASSERT_TRUE(body);
  std::vector<Camera> lenses;
  std::vector<Eigen::Isometry3d> mounts;
  for (const auto& mounted : rig.cameras) {
    lenses.push_back(mounted.camera);
    mounts.push_back(mounted.T_vehicle_camera);
  }
  const Renderer renderer(world, lenses, mounts);
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    std::vector<cv::Mat> images;
    for (int i = 0; i < 12; ++i) {
      const double turn = 0.9 * i;
      const Eigen::Isometry3d T = world.ground.stand(
          11.0 + 4.0 * std::cos(turn), 12.0 + 5.0 * std::sin(0.7 * turn), turn + 1.5, 2.58, 1.52);
      images.push_back(develop(renderer.render(c, {T * mounts[c]}).brightness, {}, 1,
                               static_cast<std::uint64_t>(i), c, 0));
    }
    const cv::Mat& car = renderer.own_car_mask(c);
    const Overlap measured = overlap_of(find_still_parts(images, rig.cameras[c]), car, lenses[c]);
    EXPECT_GT(measured.found, 0.98) << c;
    EXPECT_LT(measured.outside, 0.025) << c;
    const Overlap box = overlap_of(pixels_of_body(*body, lenses[c], mounts[c]), car, lenses[c]);
    EXPECT_GT(box.found, 0.97) << c;
    EXPECT_LT(box.outside, 0.015) << c;
    std::printf("cam%zu: measured %.3f found, %.4f beside; box %.3f found, %.4f beside\n", c,
                measured.found, measured.outside, box.found, box.outside);
  }
}

}  // namespace
}  // namespace roadbook
