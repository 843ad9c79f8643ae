#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/se3.hpp"
#include "sim/render/renderer.hpp"
#include "sim/streams/rig.hpp"
#include "sim/world/path.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {
namespace {

Scenario coarse(const std::string& name) {
  Scenario scenario = load_scenario(name, {.image_scale = 0.25});
  scenario.ground.texel_m = 0.02;
  return scenario;
}

// What one camera sees from places on the ground.
class Eye {
 public:
  Eye(const Scenario& scenario, std::size_t camera)
      : world_(make_world(scenario, {}, 0)), mounted_(make_rig(scenario.cameras).cameras[camera]) {
    RenderOptions options;
    options.own_car = false;
    renderer_ = std::make_unique<Renderer>(world_, std::vector{mounted_.camera},
                                           std::vector{mounted_.T_vehicle_camera}, options);
  }
  [[nodiscard]] cv::Mat look(double x, double y, double near_m) const {
    const Eigen::Isometry3d T = world_.ground.stand(x, y, 0.0, 2.6, 1.5, near_m);
    return renderer_->render(0, {T * mounted_.T_vehicle_camera}).brightness;
  }

 private:
  World world_;
  MountedCamera mounted_;
  std::unique_ptr<Renderer> renderer_;
};

// Share of the pixels with a texture whose brightness is the same within 4 of 255.
double equal_share(const cv::Mat& a, const cv::Mat& b) {
  int equal = 0;
  int all = 0;
  for (int y = 0; y < a.rows; ++y)
    for (int x = 0; x < a.cols; ++x) {
      if (a.at<float>(y, x) <= 0.0F) continue;
      ++all;
      equal += std::abs(a.at<float>(y, x) - b.at<float>(y, x)) < 4.0F ? 1 : 0;
    }
  return static_cast<double>(equal) / all;
}

TEST(EqualParts, StoreysLookTheSameFromTheSamePlace) {
  const Scenario scenario = coarse("storeys");
  const Eye eye(scenario, 0);
  const double up = scenario.ground.storeys->height_m;
  const cv::Mat below = eye.look(3.0, 6.0, 0.0);
  EXPECT_GT(equal_share(below, eye.look(3.0, 6.0, up)), 0.97);
  EXPECT_LT(equal_share(below, eye.look(4.0, 6.0, up)), 0.6);
}

TEST(EqualParts, BaysLookTheSameFromBayToBay) {
  const Scenario scenario = coarse("bays");
  const Eye eye(scenario, 3);  // to the right: bays
  const double step = scenario.bays->step_m();
  const cv::Mat one = eye.look(14.0, 6.0, 0.0);
  EXPECT_GT(equal_share(one, eye.look(14.0 + step, 6.0, 0.0)), 0.9);
  EXPECT_LT(equal_share(one, eye.look(14.0 + 0.5 * step, 6.0, 0.0)), 0.6);
}

TEST(EqualParts, BaysHaveTheSameSpacesAndCars) {
  const Scenario scenario = load_scenario("bays");
  const Layout layout = make_layout(scenario);
  EXPECT_EQ(layout.spaces.size(), 16U);
  ASSERT_EQ(layout.cars.size(), 8U);
  for (std::size_t i = 1; i < layout.cars.size(); ++i) {
    EXPECT_EQ(layout.cars[i].model, layout.cars[0].model);
    EXPECT_EQ(layout.cars[i].heading, layout.cars[0].heading);
    const Eigen::Vector2d by = layout.cars[i].centre - layout.cars[0].centre;
    EXPECT_NEAR(by.x(), 2.5 * static_cast<double>(i), 1e-9);
    EXPECT_NEAR(by.y(), 0.0, 1e-9);
    const auto space = static_cast<std::size_t>(layout.cars[i].space);
    EXPECT_LT((layout.spaces[space].centre - layout.cars[i].centre).norm(), 0.5);
  }
}

TEST(EqualParts, ADriveClimbsTheRampToTheUpperStorey) {
  const Scenario scenario = load_scenario("storeys");
  const Ground ground(scenario.ground);
  Random random(5, "driver");
  const VehicleMotion motion =
      drive_line(route_line(scenario, scenario.route), 1, {}, scenario.vehicle, ground, {}, random);
  const double height = scenario.ground.storeys->height_m;
  EXPECT_NEAR(motion.T_world_vehicle(0.0).translation().z(), 0.0, 1e-12);
  EXPECT_NEAR(motion.T_world_vehicle(motion.duration_s()).translation().z(), height, 1e-9);
  Eigen::Vector3d before = motion.T_world_vehicle(0.0).translation();
  double steepest = 0.0;
  for (double t = 0.1; t < motion.duration_s(); t += 0.1) {
    const Eigen::Isometry3d T = motion.T_world_vehicle(t);
    EXPECT_GE(T.translation().z(), before.z() - 0.06);
    EXPECT_LT((T.translation() - before).norm(), 0.1 * scenario.vehicle.max_speed + 0.06);
    before = T.translation();
    steepest = std::max(steepest, T.linear()(2, 0));
  }
  EXPECT_NEAR(steepest, std::sin(std::atan(height / 14.8)), 1e-3);
}

std::string error_of_lot(const std::string& more, const std::string& ground) {
  try {
    (void)parse_scenario("name: lot\nground: {low: [0, 0], high: [20, 20]" + ground +
                             "}\nlanes:\n  - {name: a, points: [[2, 2], [18, 2]]}\nroute: [a]\n" +
                             more,
                         "lot.yaml");
  } catch (const BadInput& e) {
    return e.what();
  }
  return "";
}

TEST(EqualParts, WrongOnesAreNamed) {
  const std::string ramp = ", storeys: {height: 3, ramp_from: [2, 10], ramp_to: ";
  EXPECT_NE(error_of_lot("", ramp + "[18, 10]}").find("no ceiling below the next floor"),
            std::string::npos);
  EXPECT_NE(error_of_lot("", ramp + "[18, 11]}").find("a ramp along x or y"), std::string::npos);
  EXPECT_NE(error_of_lot("", ramp + "[8, 10]}").find("a longer ramp"), std::string::npos);
  EXPECT_EQ(error_of_lot("ceiling: {height: 2.7}\n", ramp + "[18, 10]}"), "");
  const std::string bay = "bays: {low: [2, 2], high: ";
  EXPECT_NE(error_of_lot(bay + "[4.505, 18], count: 3}\n", "").find("a whole number"),
            std::string::npos);
  EXPECT_EQ(error_of_lot(bay + "[4.5, 18], count: 3}\n", ""), "");
}

}  // namespace
}  // namespace roadbook
