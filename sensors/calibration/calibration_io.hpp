#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sensors/rig.hpp"

namespace roadbook {

// Camera calibrations in the files of other programs: Kalibr, OpenCV (and ROS), CamOdoCal, Basalt.
//
// docs/reference/sensors.md lists keys, parameter orders and conventions of each. All readers
// gather every fault of a file and throw BadInput with file, line, field, the value found and the
// value expected: wrong types and counts, numbers that are not finite, focal lengths that are not
// positive, models that roadbook does not have, rotations that are left-handed or not orthonormal.

/// The reference frame of `T_vehicle_camera` in a calibration file.
enum class CalibrationFrame {
  kNone,         ///< the file has no poses: all are the identity
  kFirstCamera,  ///< the first camera
  kBody,         ///< Kalibr's and Basalt's "imu"; in roadbook's own files, the vehicle
};

struct Calibration {
  Rig rig;
  CalibrationFrame frame = CalibrationFrame::kNone;
  /// By camera: whether the file states `time_offset_s`; empty for formats that never do.
  std::vector<bool> states_time;
};

/// Reads any of the formats below. The keys of the file decide the format (JSON: the file's name).
[[nodiscard]] Calibration read_calibration(const std::filesystem::path& file);

/// Reads Kalibr's camchain.yaml: cam0, cam1, ... with `T_cam_imu` (camera <- body; `T_imu_cam` is
/// its inverse, OpenVINS) or `T_cn_cnm1` (camera <- previous camera). If a camera has both, they
/// must agree to 1e-3. `timeshift_cam_imu`: seconds to add to the camera's stamps.
[[nodiscard]] Calibration read_kalibr_camchain(const std::filesystem::path& file);

/// Reads one camera of an OpenCV file or a ROS camera_info file: camera_matrix, dist_coeffs (or
/// distortion_coefficients), resolution (or image_width, image_height; 0 x 0 without both). Four
/// coefficients are those of cv::fisheye, because cv::calibrateCamera never writes four, unless
/// `distortion_model` (or `camera_model`) states another model. All after the fourth must be 0.
[[nodiscard]] Calibration read_opencv_calibration(const std::filesystem::path& file);

/// Reads one camera of CamOdoCal (also the fisheyes of KITTI-360): model_type MEI, KANNALA_BRANDT
/// or PINHOLE.
[[nodiscard]] Calibration read_camodocal_calibration(const std::filesystem::path& file);

/// Reads Basalt's calibration JSON: cameras of type ds, kb4, ucm or pinhole.
[[nodiscard]] Calibration read_basalt_calibration(const std::filesystem::path& file);

/// Returns the text of a camchain.yaml for Kalibr and `read_kalibr_camchain`; the body is the
/// vehicle. Numbers are the shortest that read back to the same bits, always with a point or an
/// exponent (Kalibr refuses whole numbers as focal lengths).
[[nodiscard]] std::string kalibr_camchain_text(const Rig& rig);

}  // namespace roadbook
