#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "roadnet/network.hpp"

namespace roadbook::test {

/// A car park as roads between places, with the properties that its network must have.
struct Lot {
  std::string name;
  std::vector<Eigen::Vector3d> places;
  std::vector<std::pair<int, int>> roads;
  bool one_way = false;  ///< roads are driven from first to second only
  int intersections = 0;
  int lanes = 0;
  int cycle_rank = 0;
};

constexpr int kLotShapes = 7;

/// Shape 0..kLotShapes-1 with sizes drawn from `seed`: rectangle with aisles, rectangle with dead
/// ends, figure 8, crossings, one-way ring, T, and a ring with a way in.
[[nodiscard]] Lot random_lot(int shape, std::uint64_t seed);

/// Drives every road at least once a lap, with rounded corners and `step_m` between positions. Each
/// lap has a slowly varying lateral offset of standard deviation `scatter_m`. At a dead end, the
/// vehicle drives back in reverse gear, which is a separate pass.
[[nodiscard]] std::vector<DrivenPass> drive_lot(
    const Lot& lot, int laps, double scatter_m, double step_m, std::uint64_t seed);

}  // namespace roadbook::test
