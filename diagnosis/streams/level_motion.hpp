#pragma once

#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// Turn rates [rad/s] about the vehicle's y axis (to its left), at the stamps of the gyro.
using PitchRates = std::vector<GyroSample>;

/// Makes the streams those of the same motion seen from above, where the motion model holds. On a
/// slope a wheel rolls farther than the map shows, and a gyro about the car's own axis turns less
/// than the heading:
///   horizontal way = cos(slope) way,
///   heading rate = (cos(bank) w_z + sin(bank) w_y) / cos(slope)
///                = (w_z - sin(bank) d slope / dt) / (cos(slope) cos(bank))
/// (Euler angles yaw, pitch, roll; pitch = -slope). The second form is for wheels, and for a gyro
/// with one axis, where `pitch_rates` are empty. `road`: of the road under the wheels. `body`: of
/// the gyro, which may be mounted off level. Both ascend in time; before and after them the first
/// and the last hold. A stream stays as it is if no attitude of the whole drive is off level by
/// more than 0.01 rad, or if one is by more than 0.6 rad, which no road is. Steering angles do not
/// change: they are about the car's own axis, and slip-free rolling on a plane road has the
/// curvature of that plane.
void level_motion(const std::vector<Attitude>& road,
                  const std::vector<Attitude>& body,
                  const PitchRates& pitch_rates,
                  MotionStreams& streams);

/// Slopes of the road from heights [m] along the way, for references that have no attitude: lines
/// over 4 m of way, or over as much as gives the slope to 0.01 rad by the scatter of the heights,
/// up to 200 m. Bank is 0. Heights and poses are of the same stamps.
[[nodiscard]] std::vector<Attitude> slopes_of(const std::vector<PoseSample>& poses,
                                              const std::vector<double>& heights_m);

}  // namespace roadbook
