#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "drive/drive_options.hpp"
#include "drive/readings.hpp"
#include "drive/stream_summary.hpp"
#include "sensors/effects.hpp"
#include "sensors/range.hpp"
#include "sensors/rig.hpp"
#include "sensors/vehicle.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// A recorded drive in the ASL/EuRoC layout (docs/reference/drive_format.md), opened for reading.
//
// Opening validates everything but the pixels: calibration, headers, stamps, values, image files
// (their headers: size and type, without decoding). Rows and images are streamed: what stays in
// memory is one small index entry a frame.

class Drive {
 public:
  /// Opens DRIVE (with or without a `mav0/` level). Throws BadInput that carries every error and
  /// warning found, if there is an error.
  static Drive open(const std::filesystem::path& folder, const DriveOptions& options = {});

  Drive(Drive&&) noexcept;
  Drive& operator=(Drive&&) noexcept;
  ~Drive();

  [[nodiscard]] const std::filesystem::path& folder() const;
  [[nodiscard]] std::string name() const;  ///< last part of the folder's path
  [[nodiscard]] const Rig& rig() const;
  /// Survivable damage found so far, reading included: missing images, gaps.
  [[nodiscard]] std::vector<Problem> warnings() const;
  [[nodiscard]] const std::vector<StreamSummary>& streams() const;

  /// Instants at which at least one camera has an image, ascending; stamps of the shared clock: the
  /// cameras' time offsets are added. Stamps of one instant's images may differ by
  /// DriveOptions::stamp_tolerance_s; the instant has the stamp of the first camera that has an
  /// image (frame_index.hpp).
  [[nodiscard]] std::size_t frame_count() const;
  [[nodiscard]] std::int64_t frame_stamp_ns(std::size_t frame) const;
  /// Stamp of the camera's image; of the instant where the camera has none.
  [[nodiscard]] std::int64_t image_stamp_ns(std::size_t frame, std::size_t camera) const;
  /// The same as the camera's table has it, without the camera's time offset.
  [[nodiscard]] std::int64_t written_stamp_ns(std::size_t frame, std::size_t camera) const;
  [[nodiscard]] bool has_image(std::size_t frame, std::size_t camera) const;
  [[nodiscard]] std::filesystem::path image_path(std::size_t frame, std::size_t camera) const;
  /// The camera's `mask.png` (any size, 0: own vehicle); empty where the drive has none.
  [[nodiscard]] std::optional<std::filesystem::path> mask_path(std::size_t camera) const;
  /// Grey 8-bit image; empty (and a counted warning) where it is missing or damaged. Safe to call
  /// concurrently.
  [[nodiscard]] cv::Mat read_image(std::size_t frame, std::size_t camera) const;
  /// The image at half size, means of 2x2 pixels: what Camera::scaled(0.5) projects to.
  [[nodiscard]] cv::Mat read_image_half(std::size_t frame, std::size_t camera) const;

  /// Measures from vehicle.yaml; empty where the drive has no such file.
  [[nodiscard]] const std::optional<VehicleMeasures>& vehicle() const;
  [[nodiscard]] const std::optional<WheelModel>& wheel_model() const;
  /// Corrects known imperfections in everything read from here on: rig, wheel model, wheel and IMU
  /// readings (sensors/correction.hpp; the gyro's bias about z). A latency of all images is
  /// corrected in the stamps of all other sensors. Files, digest, images and truth stay unchanged.
  /// Drifting clocks agree at the first image, or without images at the first pose. Throws BadInput
  /// for unknown effects.
  void correct(const EffectSizes& sizes);

  /// Calls `visit` for every wheel row in order; streamed (corrected ones are kept in memory).
  /// Stamps as written: the wheel model holds the time offset.
  void for_each_wheel_reading(const std::function<void(const WheelReading&)>& visit) const;
  /// All rows; convenience over `for_each_wheel_reading`.
  [[nodiscard]] std::vector<WheelReading> wheel_readings() const;

  /// Geometry of range0's beams, where its sensor.yaml states it.
  [[nodiscard]] const std::optional<RangeModel>& range_model() const;
  /// Streams IMU, friction and range rows in order; calls nothing where the drive has no such
  /// stream. IMU and friction rows refer to the vehicle: the time offset of their sensor.yaml is
  /// added to the stamps, and the IMU's T_BS rotates its readings (about and along the vehicle's
  /// axes, at the IMU's place). Range rows come as written: `range_model` holds pose and offset.
  void for_each_imu_reading(const std::function<void(const ImuReading&)>& visit) const;
  void for_each_friction_reading(const std::function<void(const FrictionReading&)>& visit) const;
  void for_each_range_reading(const std::function<void(const RangeReading&)>& visit) const;
  /// Class-index image of a camera's frame (segmentationN whose sensor.yaml names the camera);
  /// empty where there is no such image.
  [[nodiscard]] cv::Mat read_segmentation(std::size_t frame, std::size_t camera) const;

  /// Truth or reference poses (state_groundtruth_estimate0); empty where the drive has no such
  /// poses.
  [[nodiscard]] std::vector<TimedPose> truth() const;

  /// Hash of calibration, tables and image sizes/names. An equal hash means an unchanged drive.
  [[nodiscard]] std::string digest() const;

 private:
  struct Impl;
  explicit Drive(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace roadbook
