#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "drive/readings.hpp"
#include "sensors/range.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Writes recorded drives in the native format (docs/reference/drive_format.md), so that Drive reads
// back exactly what was written.

struct DriveWriterOptions {
  bool overwrite = false;     ///< replaces a drive that is there already
  std::string comment;        ///< goes into every sensor.yaml
  double camera_rate_hz = 0;  ///< nominal rates for the sensor.yaml files; 0: not stated
  double wheel_rate_hz = 0;
};

/// Streams one drive to disk: create, write rows and images in time order, `finish`.
///
/// Images of different cameras may be written concurrently, and together with one thread that
/// writes the other streams; calls for one camera must not overlap. Failing to write throws
/// StorageError. Same calls, same bytes.
class DriveWriter {
 public:
  /// Creates the folder and the sensor.yaml files. Throws InvalidOption where the folder exists and
  /// is not empty (unless `options.overwrite`; then only a folder that holds a drive, or nothing,
  /// is replaced).
  DriveWriter(std::filesystem::path folder,
              const Rig& rig,
              const std::optional<WheelModel>& wheels,
              const DriveWriterOptions& options = {});
  ~DriveWriter();

  [[nodiscard]] const Rig& rig() const;

  /// `grey`: 8-bit, one channel, of the camera's size. Stamps ascend per camera.
  void write_image(std::size_t camera, std::int64_t t_ns, const cv::Mat& grey);
  /// Copies a PNG or JPEG file without conversion. Throws BadInput where the file is not a whole
  /// image of the camera's size.
  void copy_image(std::size_t camera, std::int64_t t_ns, const std::filesystem::path& source);
  /// Class-index image (8 bit) of the camera's image at that time.
  void write_segmentation(std::size_t camera, std::int64_t t_ns, const cv::Mat& classes);
  /// Cumulative angles; a drive has steering in all rows or in none (first row decides; a later
  /// reading without it leaves its cell empty).
  void write_wheels(const WheelReading& reading);
  void write_imu(const ImuReading& reading);
  /// Surface and temperature in all rows or in none.
  void write_friction(const FrictionReading& reading);
  /// Writes the measures of the vehicle to vehicle.yaml in the folder of the sensors.
  void write_vehicle(const VehicleMeasures& vehicle);
  /// Geometry of the beams; once, before their first row.
  void set_range_model(const RangeModel& model);
  /// Writes one range row. The rows of one instant follow each other, beams ascending.
  void write_range(const RangeReading& reading);
  /// Truth or reference: 8 columns (stamp, position, quaternion w first). Once a drive.
  void write_truth(const std::vector<TimedPose>& poses);
  /// Where the vehicle truly was, of a drive whose reference poses are wrong on purpose:
  /// `truth/poses` (see `true_poses`).
  void write_true_poses(const std::vector<TimedPose>& poses);

  /// Flushes and syncs everything to disk. Without it the drive is not complete.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
