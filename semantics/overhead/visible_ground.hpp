#pragma once

#include <cstdint>
#include <vector>

#include "mapping/map.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_camera.hpp"

namespace roadbook {

// The ground on which somebody would have been seen: what makes "nobody was there" evidence.
// Cameras see it where feet and crown of a person are in the image and not behind the own car;
// things that stand there, known from the map's raised landmarks, hide what is behind them.

struct VisibleGroundOptions {
  double max_range_m = 10.0;  ///< from a camera
  double person_m = 1.7;      ///< height of somebody
  double cell_m = 0.25;       ///< of what stands there
  int fewest_landmarks = 2;   ///< of a cell that hides
  double lowest_m = 0.3;      ///< of landmarks that hide, over the ground
  double highest_m = 1.6;
  double max_sigma_m = 0.3;  ///< landmarks less certain than this tell nothing
};

/// Middles of the square cells (`cell_m`, map frame) in which something stands: raised landmarks,
/// at least `fewest_landmarks` of them between `lowest_m` and `highest_m` over the ground.
[[nodiscard]] std::vector<Eigen::Vector2d> standing_cells(const Map& map,
                                                          const GroundModel& ground,
                                                          const VisibleGroundOptions& options);

class VisibleGround {
 public:
  static constexpr int kBearings = 72;  ///< counter-clockwise from the vehicle's heading

  /// Keeps what it needs of `map`.
  VisibleGround(const Map& map,
                const GroundModel& ground,
                const std::vector<PersonCamera>& cameras,
                const VisibleGroundOptions& options = {});

  /// How far the ground is seen from the vehicle's origin in each bearing [m], 0.1 m steps. What
  /// the own car hides close by is passed over. `has_image[c]`: camera c saw something.
  [[nodiscard]] std::vector<double> reach_m(const Eigen::Isometry3d& T_map_vehicle,
                                            const std::vector<bool>& has_image) const;

 private:
  VisibleGroundOptions options_;
  std::vector<Eigen::Vector2d> camera_places_;  ///< vehicle frame
  std::vector<Eigen::Vector2d> obstacles_;      ///< middles of cells, map frame
  int steps_ = 0;
  std::vector<std::uint16_t> seen_by_;  ///< by bearing and step: a bit a camera
};

}  // namespace roadbook
