#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// The streams thinned to the bandwidth in which the motion model is meant to hold: one wheel
// reading and one mean of steering and gyro a knot interval, every pose.

/// One kind of scalar that is predicted and compared. Wheels: increments from reading to reading.
enum class Channel {
  kWheelDistance,  ///< [m], mean of both wheels
  kWheelHeading,   ///< [rad], their difference over the track
  kSteering,       ///< [rad]
  kGyro,           ///< [rad/s]
  kPoseAlong,      ///< [m], in the vehicle's direction
  kPoseAcross,     ///< [m], to its left
  kPoseHeading,    ///< [rad]
};
inline constexpr std::size_t kChannels = 7;
[[nodiscard]] constexpr std::size_t index_of(Channel channel) {
  return static_cast<std::size_t>(channel);
}
/// Stream as the report names it ("wheels0", "poses", ...), and the channel within it.
[[nodiscard]] std::string_view stream_of(Channel channel);
[[nodiscard]] std::string_view name_of(Channel channel);

struct WheelObservation {
  double t_s = 0.0;
  double distance_m = 0.0;  ///< nominal wheels, cumulative; of one wheel what it has rolled
  double heading = 0.0;
  double left_rad = 0.0;  ///< angle of the wheel: its phase
  double right_rad = 0.0;
};
struct WindowObservation {
  double begin_s = 0.0;  ///< readings spread evenly over [begin, end]
  double end_s = 0.0;
  double value = 0.0;  ///< their mean
  std::size_t count = 0;
  double squares = 0.0;  ///< sum, about the line through the readings
  double lagged = 0.0;   ///< sum of products of neighbours, about that line
};

struct Observations {
  WheelModel wheel_model;
  WheelsRead wheels_read = WheelsRead::kBoth;
  bool poses_have_heading = true;
  bool poses_of_map = false;
  double origin_s = 0.0;  ///< all clocks agree here, also drifting ones
  double step_s = 0.08;
  std::vector<PoseSample> poses;  ///< headings unwrapped
  std::vector<WheelObservation> wheels;
  std::vector<WheelObservation> wheel_readings;  ///< all of them: of their noise alone
  std::vector<WindowObservation> steering;
  std::vector<WindowObservation> gyro;
  double steering_step_rad = 0.0;  ///< of coarse readings (`coarse_step`); else 0
  double gyro_step_rad_s = 0.0;
  std::vector<ColumnCovariate> columns;  ///< of those logged the ones that vary

  /// Rows of a channel; wheels: increments, one fewer than readings; none of what is not read.
  [[nodiscard]] std::size_t rows(Channel channel) const;
  /// First row of a channel when all channels stand one after another; `kChannels`: all rows.
  [[nodiscard]] std::array<std::size_t, kChannels + 1> offsets() const;
};

struct ObservationOptions {
  double step_s = 0.08;  ///< a knot interval: 6 Hz of bandwidth, above what a car's motion has
  double max_gap_s = 0.5;
};

/// Cuts all streams to the time that the poses cover.
[[nodiscard]] Observations observe(const MotionStreams& streams,
                                   const ObservationOptions& options = {});

}  // namespace roadbook
