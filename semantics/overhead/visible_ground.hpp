#pragma once

#include <cstdint>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_camera.hpp"

namespace roadbook {

// Ground on which a person would have been visible: the evidence that nobody was there. A camera
// observes a ground point if feet and crown of a person there are in its image and not behind the
// own vehicle. Obstacles, known from raised landmarks of the map, hide the ground behind them.

struct VisibleGroundOptions {
  double max_range_m = 10.0;  ///< from a camera
  double person_m = 1.7;      ///< height of a person
  double cell_m = 0.25;       ///< cells for obstacles
  int fewest_landmarks = 2;   ///< smallest number of landmarks in an obstacle cell
  double lowest_m = 0.3;      ///< lowest landmark of an obstacle, above the ground
  double highest_m = 1.6;     ///< highest one
  double max_sigma_m = 0.3;   ///< less certain landmarks are ignored
};

/// Centres of the square cells (`cell_m`, map frame) that hold an obstacle: at least
/// `fewest_landmarks` landmarks between `lowest_m` and `highest_m` above the ground.
[[nodiscard]] std::vector<Eigen::Vector2d> standing_cells(const Map& map,
                                                          const GroundModel& ground,
                                                          const VisibleGroundOptions& options);

class VisibleGround {
 public:
  static constexpr int kBearings = 72;  ///< counter-clockwise from the vehicle's heading

  /// Copies what it needs of `map`.
  VisibleGround(const Map& map,
                const GroundModel& ground,
                const std::vector<PersonCamera>& cameras,
                const VisibleGroundOptions& options = {});

  /// Distance from the vehicle's origin up to which the ground is observed, for each bearing [m],
  /// in steps of 0.1 m. Ground close by that only the own vehicle hides does not end the range.
  /// `has_image[c]`: camera c has an image.
  [[nodiscard]] std::vector<double> reach_m(const Eigen::Isometry3d& T_map_vehicle,
                                            const std::vector<bool>& has_image) const;

 private:
  VisibleGroundOptions options_;
  std::vector<Eigen::Vector2d> camera_places_;  ///< positions, vehicle frame
  std::vector<Eigen::Vector2d> obstacles_;      ///< centres of cells, map frame
  int steps_ = 0;
  std::vector<std::uint16_t> seen_by_;  ///< by bearing and step: one bit per camera
};

}  // namespace roadbook
