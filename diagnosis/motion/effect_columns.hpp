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
/// How readings that slip so much inside change as the disc moves along the way and as its radius
/// grows, by a metre each: two columns. Across the way one pass tells nothing. Differences over
/// half a metre, as far as a step of the wheels reaches.
[[nodiscard]] Columns disc_columns(const WheelSteps& wheels, const Candidate& disc, double slip);

}  // namespace roadbook
