#pragma once

#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

/// Fills the knots of `trajectory` from positions that scatter too much to show a course: the way
/// that wheels and gyro (or wheels and steering) reckon is laid onto the positions, by a turn and a
/// shift for each knot that fit the positions about it best (least squares). About each knot as
/// many positions are taken as tell the turn to 0.02 rad, within 30 s to either side. False, and
/// nothing changed, where the other streams do not tell speed and turn over the whole drive, or
/// where the car hardly moves. `scatter_m`: standard deviation of a position.
[[nodiscard]] bool lay_way_on_positions(const Observations& obs,
                                        double scatter_m,
                                        Trajectory& trajectory);

}  // namespace roadbook
