#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "drive/problem_list.hpp"
#include "sensors/range.hpp"
#include "sensors/rig.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// The sensor.yaml files of a drive: EuRoC's keys with Kalibr's names for the models
// (docs/reference/drive_format.md lists them all).

/// The entries of sensor.yaml other than the model itself.
struct SensorInfo {
  std::string comment;
  double rate_hz = 0.0;  ///< nominal; 0: not stated
};

struct CameraFile {
  MountedCamera camera;
  SensorInfo info;
};
struct WheelFile {
  WheelModel wheels;
  SensorInfo info;
};
/// Of imu0, friction0, segmentation0, range0: where the sensor is, in space and time.
struct StreamFile {
  SensorInfo info;
  Eigen::Isometry3d T_vehicle_sensor = Eigen::Isometry3d::Identity();
  double time_offset_s = 0.0;       ///< to add to the stamps
  std::string camera;               ///< segmentation: the camera whose images it explains
  std::optional<RangeModel> range;  ///< range: where the file states the beams
};

/// Nanoseconds to add to stamps of a sensor with this time offset.
[[nodiscard]] std::int64_t offset_ns(double time_offset_s);

/// Each reads one file, adds every fault to `problems`, and is empty where there was an error.
/// `name` is the camera's ("cam0"); larger images than `max_megapixels` are an error. Sizes that no
/// vehicle or lens has are errors or warnings (plausible.hpp).
[[nodiscard]] std::optional<CameraFile> read_camera_yaml(const std::filesystem::path& file,
                                                         const std::string& name,
                                                         double max_megapixels,
                                                         ProblemList& problems);
[[nodiscard]] std::optional<WheelFile> read_wheel_yaml(const std::filesystem::path& file,
                                                       ProblemList& problems);
[[nodiscard]] std::optional<StreamFile> read_stream_yaml(const std::filesystem::path& file,
                                                         ProblemList& problems);

/// The text of the files. Numbers are the shortest that read back to the same bits.
[[nodiscard]] std::string camera_yaml_text(const MountedCamera& camera, const SensorInfo& info);
[[nodiscard]] std::string wheel_yaml_text(const WheelModel& wheels, const SensorInfo& info);
[[nodiscard]] std::string range_yaml_text(const RangeModel& model, const SensorInfo& info);
[[nodiscard]] std::string stream_yaml_text(const std::string& sensor_type,
                                           const StreamFile& stream);

}  // namespace roadbook
