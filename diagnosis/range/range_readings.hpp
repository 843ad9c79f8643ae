#pragma once

#include <string>
#include <vector>

#include "diagnosis/range/range_map.hpp"
#include "diagnosis/streams/streams.hpp"
#include "drive/drive.hpp"

namespace roadbook {

/// A reading and what should have been read.
struct ExpectedRange {
  double t_s = 0.0;
  std::size_t beam = 0;
  double read_m = 0.0;
  double expected_m = 0.0;
  double speed = 0.0;     ///< of the vehicle [m/s]
  double yaw_rate = 0.0;  ///< [rad/s]
  /// Change of the expected range with the sensor's place (x, y) and per radian of its heading.
  Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();
};

/// A drive's range readings beside what the rest of them, at the reference poses, let expect.
struct RangeReadings {
  std::vector<ExpectedRange> samples;
  double max_m = 0.0;
  std::size_t left_out = 0;  ///< readings of which nothing certain can be expected
  std::vector<std::string> notes;
  std::vector<std::vector<RangeBeam>> beams;  ///< that these are from, of each drive
};

[[nodiscard]] RangeReadings expect_ranges(const std::vector<RangeBeam>& beams, double max_m);
/// The beams of a native drive; empty readings, with a note, where its sensor.yaml does not say
/// where they look. The poses' stamps are `late_s` after those that beams of the same moment have.
[[nodiscard]] RangeReadings range_readings(const Drive& drive,
                                           const std::vector<PoseSample>& poses,
                                           double late_s = 0.0);

}  // namespace roadbook
