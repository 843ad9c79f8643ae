#pragma once

#include <Eigen/Core>

#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// Wheel measurements of a row: distance [m] and heading [rad] of the nominal wheels; or the rolled
// distance of a single wheel, with heading 0, which is not used.

/// Distance and heading from the angles [rad] of the left and right wheel.
[[nodiscard]] Eigen::Vector2d rolled(const WheelModel& model,
                                     WheelsRead read,
                                     const Eigen::Vector2d& angles);

/// Predicted measurement of a motion, with effects.
[[nodiscard]] Eigen::Vector2d predict_wheel_row(const WheelModel& model,
                                                WheelsRead read,
                                                const MotionEffects& effects,
                                                const TrueMotion<double>& motion);

/// Derivative of the measurement (rows: distance, heading) by driven distance (first column) and
/// turn (second), without eccentricity. `motion`: point of linearisation; it matters only for a
/// front wheel, whose distance is hypot(distance, wheelbase * turn).
[[nodiscard]] Eigen::Matrix2d wheel_row_gain(const WheelModel& model,
                                             WheelsRead read,
                                             const MotionEffects& effects,
                                             const TrueMotion<double>& motion);

/// True if these wheels can show the effect: a single wheel contains nothing of the other.
[[nodiscard]] bool shows_effect(WheelsRead read, std::string_view effect);

}  // namespace roadbook
