#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>

namespace roadbook {

// Rows of a drive's streams other than images and wheels.

/// A pose of truth or reference.
struct TimedPose {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
};

/// One IMU row. In a table in the IMU's frame and clock, from `Drive` in the vehicle's
/// (T_BS and time_offset of imu0 applied); DriveWriter writes the identity and no offset.
struct ImuReading {
  std::int64_t t_ns = 0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();
};

/// Class of ground with water on it, in class images and friction tables.
inline constexpr int kWaterSurface = 5;

/// One friction measurement at the vehicle.
struct FrictionReading {
  std::int64_t t_ns = 0;
  double friction = 0.0;
  double sigma = 0.0;
  std::optional<int> surface = std::nullopt;           ///< class under the wheels, as labelled
  std::optional<double> temperature_c = std::nullopt;  ///< [degrees Celsius]
};

/// One beam of a range sensor.
struct RangeReading {
  std::int64_t t_ns = 0;
  std::int64_t beam = 0;
  double range_m = 0.0;
};

}  // namespace roadbook
