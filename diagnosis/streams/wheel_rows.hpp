#pragma once

#include <Eigen/Core>

#include "diagnosis/streams/motion_effects.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// What a row of the wheels reads: distance and heading of the nominal wheels, or the distance that
// one wheel has rolled (then the heading is 0 and no row of it is looked at).

/// From angles [rad] of the left and right wheel.
[[nodiscard]] Eigen::Vector2d rolled(const WheelModel& model,
                                     WheelsRead read,
                                     const Eigen::Vector2d& angles);

/// That a motion should give, effects included.
[[nodiscard]] Eigen::Vector2d predict_wheel_row(const WheelModel& model,
                                                WheelsRead read,
                                                const MotionEffects& effects,
                                                const TrueMotion<double>& motion);

/// How it changes with distance (first column) and turn (second), eccentricity left aside. Linear
/// but for a front wheel, which rolls the hypotenuse of distance and wheelbase times turn:
/// `motion` is where.
[[nodiscard]] Eigen::Matrix2d wheel_row_gain(const WheelModel& model,
                                             WheelsRead read,
                                             const MotionEffects& effects,
                                             const TrueMotion<double>& motion);

/// Whether such wheels can show the effect at all: one wheel knows nothing of the other.
[[nodiscard]] bool shows_effect(WheelsRead read, std::string_view effect);

}  // namespace roadbook
