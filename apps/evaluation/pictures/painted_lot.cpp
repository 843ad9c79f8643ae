#include "apps/evaluation/pictures/painted_lot.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/random.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/ground_paint.hpp"
#include "sim/world/layout.hpp"
#include "sim/world/row_work.hpp"

namespace roadbook {
namespace {

constexpr double kResolution = 0.04;
constexpr double kNoise = 8.0;  // [grey levels]

// In a mosaic of the ground, upright objects appear stretched away from the cameras in the aisle.
// They cover the lines behind them and at their sides.
void park_cars(const Layout& layout, std::uint64_t floor, Canvas& ground) {
  Random random(floor, "cars from above");
  for (const ParkedCar& car : layout.cars) {
    const double aisle = layout.spaces[static_cast<std::size_t>(car.space)].heading;
    const Eigen::Vector2d away(-std::cos(aisle), -std::sin(aisle));
    const Eigen::Vector2d aside(-away.y(), away.x());
    const double grey = random.uniform(40.0, 200.0);
    constexpr int kStreaks = 7;
    for (int i = 0; i < kStreaks; ++i) {
      const double at = (i - 0.5 * (kStreaks - 1)) * 0.3;
      const double lean = at * random.uniform(0.2, 0.7);
      const Eigen::Vector2d front = car.centre - 2.1 * away + at * aside;
      const Eigen::Vector2d end =
          car.centre + random.uniform(2.0, 4.5) * away + (at + lean) * aside;
      fill_convex(ground, strip(front, end, 0.34), grey + 45.0 * random.normal(), 0.9, 0.1);
    }
  }
}

// Applies exposure changes between parts of the drive.
void shade(std::uint64_t floor, cv::Mat& grey) {
  Random random(floor, "exposure");
  cv::Mat coarse(6, 9, CV_32F);
  for (int i = 0; i < 54; ++i)
    coarse.at<float>(i / 9, i % 9) = static_cast<float>(random.uniform(0.65, 1.35));
  cv::Mat gain;
  cv::resize(coarse, gain, grey.size(), 0, 0, cv::INTER_CUBIC);
  cv::Mat bright;
  grey.convertTo(bright, CV_32F);
  cv::multiply(bright, gain, bright);
  bright.convertTo(grey, CV_8U);
}

OrientedBox box_of_space(const ParkingSpace& space) {
  OrientedBox box;
  box.centre = space.centre;
  box.heading = space.heading;
  const double a = (space.corners[1] - space.corners[0]).norm();
  const double b = (space.corners[2] - space.corners[1]).norm();
  box.length_m = std::max(a, b);
  box.width_m = std::min(a, b);
  return box;
}

}  // namespace

PaintedLot painted_lot(const std::string& scenario,
                       const std::string& size,
                       std::uint64_t floor,
                       int num_threads) {
  ScenarioOptions options;
  options.size = size;
  Scenario place = load_scenario(scenario, options);
  place.seed += 1000 * floor;
  Random wear(floor, "wear");
  for (SpaceRowSpec& row : place.rows) {
    row.wear = wear.uniform(0.3, 0.75);
    row.occupied = wear.uniform(0.35, 0.65);
  }
  const Layout layout = make_layout(place);
  PaintedGround painted = paint_ground(place, layout, RowWork{num_threads, {}});
  Canvas& ground = painted.brightness;
  park_cars(layout, floor, ground);
  PaintedLot lot;
  cv::Mat& grey = lot.image.grey;
  const double shrink = ground.texel_m / kResolution;
  cv::flip(ground.image, grey, 0);  // north up
  cv::resize(grey, grey, {}, shrink, shrink, cv::INTER_AREA);
  cv::GaussianBlur(grey, grey, {}, 1.5);
  shade(floor, grey);
  Random random(floor, "mosaic noise");
  for (int row = 0; row < grey.rows; ++row)
    for (int column = 0; column < grey.cols; ++column) {
      auto& pixel = grey.at<unsigned char>(row, column);
      pixel = cv::saturate_cast<unsigned char>(std::max(1.0, pixel + kNoise * random.normal()));
    }
  lot.image.seen = cv::Mat(grey.size(), CV_8U, cv::Scalar(255));
  lot.image.resolution_m = kResolution;
  lot.image.corner = {ground.low.x(), ground.low.y() + ground.texel_m * ground.image.rows};
  for (const ParkingSpace& space : layout.spaces) lot.spaces.push_back(box_of_space(space));
  return lot;
}

}  // namespace roadbook
