#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"
#include "mapping/occupancy/range_map.hpp"

namespace roadbook {

/// A reading and its expected range.
struct ExpectedRange {
  double t_s = 0.0;
  std::size_t beam = 0;
  double read_m = 0.0;
  double expected_m = 0.0;
  double speed = 0.0;     ///< of the vehicle [m/s]
  double yaw_rate = 0.0;  ///< [rad/s]
  /// Derivative of the expected range by the sensor's position (x, y) and heading [m/rad].
  Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();
};

/// Range readings of a drive with the ranges expected from the other readings at the reference
/// poses.
struct RangeReadings {
  std::vector<ExpectedRange> samples;
  double max_m = 0.0;
  std::size_t left_out = 0;  ///< readings without a certain expectation
  std::vector<std::string> notes;
  std::vector<std::vector<RangeBeam>> beams;  ///< all beams, one list a drive
};

[[nodiscard]] RangeReadings expect_ranges(const std::vector<RangeBeam>& beams, double max_m);
/// The readings of a native drive; empty, with a note, if its sensor.yaml does not state the beam
/// directions. `late_s` [s]: stamps of the poses minus stamps of beams of the same time.
[[nodiscard]] RangeReadings range_readings(const Drive& drive,
                                           const std::vector<PoseSample>& poses,
                                           double late_s = 0.0);

}  // namespace roadbook
