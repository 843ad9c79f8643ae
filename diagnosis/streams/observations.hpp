#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "diagnosis/streams/streams.hpp"

namespace roadbook {

// The streams, reduced to the bandwidth in which the motion model holds. Each knot interval has one
// wheel reading and one mean of steering and gyro; every pose is kept.

/// Kinds of scalar measurements. Wheel channels are increments from reading to reading.
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
/// Name of the stream in the report ("wheels0", "poses" ...), and of the channel within it.
[[nodiscard]] std::string_view stream_of(Channel channel);
[[nodiscard]] std::string_view name_of(Channel channel);

struct WheelObservation {
  double t_s = 0.0;
  double distance_m =
      0.0;  ///< cumulative, nominal wheels; if one wheel is read, its rolled distance
  double heading = 0.0;
  double left_rad = 0.0;  ///< wheel angle
  double right_rad = 0.0;
};
struct WindowObservation {
  double begin_s = 0.0;  ///< readings are spread evenly over [begin, end]
  double end_s = 0.0;
  double value = 0.0;  ///< their mean
  std::size_t count = 0;
  double squares = 0.0;  ///< sum of squared residuals about the regression line
  double lagged = 0.0;   ///< sum of products of neighbouring residuals
};

struct Observations {
  WheelModel wheel_model;
  WheelsRead wheels_read = WheelsRead::kBoth;
  bool poses_have_heading = true;
  bool poses_of_map = false;
  bool bank_is_known = false;
  double origin_s = 0.0;  ///< time at which all clocks agree, even if one drifts
  double step_s = 0.08;
  std::vector<PoseSample> poses;  ///< headings unwrapped
  std::vector<WheelObservation> wheels;
  std::vector<WheelObservation> wheel_readings;  ///< all readings, for estimates of their noise
  std::vector<WindowObservation> steering;
  std::vector<WindowObservation> gyro;
  double steering_step_rad = 0.0;  ///< quantisation step (`coarse_step`); else 0
  double gyro_step_rad_s = 0.0;
  std::vector<ColumnCovariate> columns;  ///< logged columns that vary

  /// Number of rows of a channel. Wheels: increments, one fewer than readings. 0 if it is not read.
  [[nodiscard]] std::size_t rows(Channel channel) const;
  /// Index of the first row of each channel if all channels are concatenated; at `kChannels` the
  /// total number of rows.
  [[nodiscard]] std::array<std::size_t, kChannels + 1> offsets() const;
};

}  // namespace roadbook
