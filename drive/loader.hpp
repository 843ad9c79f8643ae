#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive_options.hpp"
#include "drive/frame_index.hpp"
#include "drive/images/image_stream.hpp"
#include "drive/problem_list.hpp"
#include "drive/sensor_yaml.hpp"
#include "drive/stream_summary.hpp"
#include "sensors/range.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

/// Everything that opening a drive finds.
struct DriveContent {
  std::filesystem::path folder;   ///< as given
  std::filesystem::path sensors;  ///< the folder itself, or its mav0/
  Rig rig;
  std::vector<ImageStream> images;                   ///< by camera
  std::map<std::size_t, ImageStream> segmentations;  ///< by camera
  FrameIndex frames;
  std::optional<WheelModel> wheels;
  std::optional<VehicleMeasures> vehicle;  ///< of vehicle.yaml; empty: no such file
  std::optional<StreamFile> imu;           ///< empty: the drive has no IMU
  std::optional<StreamFile> friction;      ///< likewise
  bool has_range = false;
  std::optional<RangeModel> range;
  bool has_truth = false;
  StreamFile truth;  ///< where the poses' sensor.yaml says that they are another body's, or late
  std::vector<StreamSummary> streams;
  std::vector<std::filesystem::path> tables;  ///< every YAML file and data.csv, for the digest
};

/// Reads and validates everything but pixels. Adds every fault to `problems` and continues. The
/// result is usable if there is no error among the problems. Never throws for bad input.
[[nodiscard]] DriveContent load_drive(const std::filesystem::path& folder,
                                      const DriveOptions& options,
                                      ProblemList& problems);

/// Name of the file that says that a drive is still being written.
inline constexpr const char* kUnfinishedMark = ".unfinished";

}  // namespace roadbook
