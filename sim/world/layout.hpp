#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/scenario/scenario.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// One marked parking space.
struct ParkingSpace {
  int id = 0;      ///< ascending over the rows of the scenario
  int number = 0;  ///< painted; 0: none
  std::string row;
  Polygon corners;  ///< front right, front left (seen from the space's back), back left, back right
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double heading = 0.0;  ///< from the back to the open front
};

/// A car parked in a space.
struct ParkedCar {
  int space = 0;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double heading = 0.0;
  int model = 0;  ///< index of the car's shape and paint
};

/// A line between two spaces (or at the end of a row).
struct SpaceLine {
  Eigen::Vector2d front = Eigen::Vector2d::Zero();
  Eigen::Vector2d back = Eigen::Vector2d::Zero();
  bool column = false;  ///< a yellow column instead of paint
  double width_m = 0.12;
  double wear = 0.0;
  double paint = 0.8;
  int copy_of = -1;  ///< line of the first bay that this line looks like; -1: none
};

/// Spaces, lines and parked cars of a scenario, with coordinates.
struct Layout {
  std::vector<ParkingSpace> spaces;
  std::vector<SpaceLine> lines;
  std::vector<ParkedCar> cars;
};

constexpr int kCarModels = 9;

/// Spaces and lines depend on the scenario alone, the parked cars on its seed and visit. Copies of
/// a bay have the cars of the first bay.
[[nodiscard]] Layout make_layout(const Scenario& scenario);

}  // namespace roadbook
