#include "sim/world/layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

void add_row(const SpaceRowSpec& row, Layout& layout) {
  const Eigen::Vector2d step = (row.to - row.from) / row.count;
  const Eigen::Vector2d inwards = Eigen::Vector2d(-step.y(), step.x()).normalized();
  const Eigen::Vector2d depth = row.depth_m * inwards;
  for (int i = 0; i <= row.count; ++i) {
    SpaceLine line;
    line.front = row.from + i * step;
    line.back = line.front + depth;
    line.column = std::find(row.columns.begin(), row.columns.end(), i) != row.columns.end();
    line.width_m = row.line_width_m;
    line.wear = row.wear;
    line.paint = row.paint;
    layout.lines.push_back(line);
  }
  for (int i = 0; i < row.count; ++i) {
    ParkingSpace space;
    space.id = static_cast<int>(layout.spaces.size());
    space.number = row.first_number > 0 ? row.first_number + i : 0;
    space.row = row.name;
    const Eigen::Vector2d a = row.from + i * step;
    const Eigen::Vector2d b = a + step;
    space.corners = {a, b, b + depth, a + depth};
    space.centre =
        0.25 * (space.corners[0] + space.corners[1] + space.corners[2] + space.corners[3]);
    space.heading = std::atan2(-inwards.y(), -inwards.x());
    layout.spaces.push_back(space);
  }
}

// Parks the cars of the first bay in the row of another bay. `first_space` is by row.
void copy_cars(const Scenario& scenario,
               const SpaceRowSpec& row,
               const std::vector<int>& first_space,
               Layout& layout) {
  const auto own = static_cast<std::size_t>(row.copy_of);
  const auto copy = static_cast<std::size_t>(&row - scenario.rows.data());
  const std::size_t cars = layout.cars.size();
  for (std::size_t i = 0; i < cars; ++i) {
    ParkedCar car = layout.cars[i];
    const int index = car.space - first_space[own];
    if (index < 0 || index >= row.count) continue;
    car.space = first_space[copy] + index;
    car.centre += row.from - scenario.rows[own].from;
    layout.cars.push_back(car);
  }
}

}  // namespace

Layout make_layout(const Scenario& scenario) {
  Layout layout;
  std::vector<std::size_t> first_line;
  std::vector<int> first_space;
  for (const SpaceRowSpec& row : scenario.rows) {
    first_line.push_back(layout.lines.size());
    first_space.push_back(static_cast<int>(layout.spaces.size()));
    add_row(row, layout);
    for (std::size_t i = first_line.back(); row.copy_of >= 0 && i < layout.lines.size(); ++i)
      layout.lines[i].copy_of = static_cast<int>(first_line[static_cast<std::size_t>(row.copy_of)] +
                                                 i - first_line.back());
  }
  Random random(scenario.seed, "parked", static_cast<std::uint64_t>(scenario.visit));
  std::size_t next = 0;
  for (const SpaceRowSpec& row : scenario.rows) {
    if (row.copy_of >= 0) {
      copy_cars(scenario, row, first_space, layout);
      continue;
    }
    for (int i = 0; i < row.count; ++i, ++next) {
      const ParkingSpace& space = layout.spaces[next];
      // Every space draws the same number of values: one car more elsewhere changes none here.
      const bool occupied = random.uniform() < row.occupied;
      const bool backed_in = random.uniform() < 0.35;
      ParkedCar car;
      car.space = space.id;
      car.heading = space.heading + (backed_in ? 0.0 : std::numbers::pi) + 0.02 * random.normal();
      const double aside = std::clamp(0.08 * random.normal(), -0.2, 0.2);
      const double along = std::clamp(0.12 * random.normal(), -0.25, 0.25);
      car.centre = space.centre +
                   along * Eigen::Vector2d(std::cos(space.heading), std::sin(space.heading)) +
                   aside * Eigen::Vector2d(-std::sin(space.heading), std::cos(space.heading));
      car.model = static_cast<int>(random.below(kCarModels));
      if (occupied) layout.cars.push_back(car);
    }
  }
  return layout;
}

}  // namespace roadbook
