#pragma once

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/motion/columns.hpp"
#include "diagnosis/motion/motion_fit.hpp"

namespace roadbook {

/// Change of all rows by a named effect (index into `motion_effects`) at a point: central
/// differences of the prediction itself, at the smoothed trajectory. Raw readings would correlate
/// with their own noise (errors in variables).
[[nodiscard]] Columns effect_column(const Observations& obs,
                                    const MotionPoint& smooth,
                                    std::size_t effect);

/// The wheels' motion from reading to reading, and where: what places are laid over.
struct WheelSteps {
  struct Step {
    double x = 0.0, y = 0.0;  ///< of its middle
    double distance_m = 0.0;  ///< as the nominal wheels read it, and the turn
    double turn_rad = 0.0;    ///< 0 of one wheel
  };
  std::vector<Step> steps;
  WheelSteps() = default;
  WheelSteps(const Observations& obs, const MotionPoint& smooth);
};

/// Share of a step inside a disc whose centre is so far away: in part where it straddles the edge.
[[nodiscard]] double share_inside(const WheelSteps::Step& step, double away, double radius);

/// Wheels that turn more by a share inside a disc.
[[nodiscard]] Columns place_column(const WheelSteps& wheels, double x, double y, double radius);
/// Change of readings that slip inside a disc if the disc moves along the way by 1 m, and if its
/// radius grows by 1 m: two columns. One pass does not determine the place across the way.
/// Differences are taken over half a metre, the length of a step of the wheels.
[[nodiscard]] Columns disc_columns(const WheelSteps& wheels, const Candidate& disc, double slip);

}  // namespace roadbook
