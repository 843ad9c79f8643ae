#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/world/mesh.hpp"
#include "sim/world/vehicle.hpp"
#include "sim/world/world.hpp"

namespace roadbook {

/// Position and heading of a person at one moment (world frame).
struct PersonState {
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  double walked_m = 0.0;
};

/// The motion of all people during one drive, planned ahead. They walk back and forth along their
/// crossing and wait while the measuring car passes.
class Pedestrians {
 public:
  Pedestrians(const Scenario& scenario, const VehicleMotion& drive, std::uint64_t seed);

  static constexpr double kStep = 0.1;  ///< [s] between planned states
  [[nodiscard]] std::size_t count() const { return tracks_.size(); }
  [[nodiscard]] PersonState at(std::size_t person, double t_s) const;
  [[nodiscard]] double height_m(std::size_t person) const { return heights_[person]; }

 private:
  std::vector<std::vector<PersonState>> tracks_;
  std::vector<double> heights_;
};

/// Shapes of all people and moving cars at time t, world frame.
[[nodiscard]] Mesh moving_mesh(const World& world, const Pedestrians& people, double t_s);

}  // namespace roadbook
