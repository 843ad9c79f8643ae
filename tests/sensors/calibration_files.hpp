#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "sensors/calibration/calibration_io.hpp"

namespace roadbook::test {

/// A file that goes with the test.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name, const std::string& text = {}) {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "roadbook_calibration_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    path_ = folder_ / name;
    write(text);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path path_;
};

inline Calibration read_text(const std::string& name, const std::string& text) {
  return read_calibration(TemporaryFile(name, text).path());
}

/// The faults that reading `text` gives, a line each, without the folder; "" where it is read.
inline std::string faults_of(const std::string& name, const std::string& text) {
  try {
    (void)read_text(name, text);
    return "";
  } catch (const BadInput& bad) {
    std::string lines;
    for (Problem problem : bad.problems()) {
      problem.file = std::filesystem::path(problem.file).filename().string();
      lines += to_line(problem) + "\n";
    }
    return lines;
  }
}

/// Angle between two unit vectors [rad], also where it is tiny.
inline double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

// One camera of each model in the words of each program.

inline const char* const kKalibrFisheye = R"(cam0:
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [-0.07031853, 0.00387505, -0.00333139, 0.00056406]
  distortion_model: equidistant
  intrinsics: [422.13163849, 421.10340889, 612.82890504, 545.05656249]
  resolution: [1280, 1080]
  rostopic: /front/image_raw
)";
inline const char* const kOpenCvFisheye = R"(%YAML:1.0
---
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 422.13163849, 0., 612.82890504, 0., 421.10340889, 545.05656249,
       0., 0., 1. ]
dist_coeffs: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ -0.07031853, 0.00387505, -0.00333139, 0.00056406 ]
resolution: !!opencv-matrix
   rows: 2
   cols: 1
   dt: i
   data: [ 1280, 1080 ]
)";
inline const char* const kCamOdoCalFisheye = R"(%YAML:1.0
---
model_type: KANNALA_BRANDT
camera_name: front
image_width: 1280
image_height: 1080
projection_parameters:
   k2: -0.07031853
   k3: 0.00387505
   k4: -0.00333139
   k5: 0.00056406
   mu: 422.13163849
   mv: 421.10340889
   u0: 612.82890504
   v0: 545.05656249
)";
inline const char* const kBasaltFisheye = R"({
  "value0": {
    "T_imu_cam": [{"px": 1.0, "py": 0.5, "pz": 1.5, "qx": 0.0, "qy": 0.0, "qz": 0.6, "qw": 0.8}],
    "intrinsics": [
      {
        "camera_type": "kb4",
        "intrinsics": {
          "fx": 422.13163849, "fy": 421.10340889, "cx": 612.82890504, "cy": 545.05656249,
          "k1": -0.07031853, "k2": 0.00387505, "k3": -0.00333139, "k4": 0.00056406
        }
      }
    ],
    "resolution": [[1280, 1080]],
    "cam_time_offset_ns": 2000000
  }
})";
inline const char* const kCamOdoCalMei = R"(%YAML:1.0
---
model_type: MEI
camera_name: image_02
image_width: 1400
image_height: 1400
mirror_parameters:
   xi: 2.2134
distortion_parameters:
   k1: 0.016798
   k2: 1.6548
   p1: 0.00042
   p2: 0.00042
projection_parameters:
   gamma1: 1336.3
   gamma2: 1335.8
   u0: 716.94
   v0: 705.76
)";
inline const char* const kKalibrMei = R"(cam0:
  camera_model: omni
  distortion_coeffs: [0.016798, 1.6548, 0.00042, 0.00042]
  distortion_model: radtan
  intrinsics: [2.2134, 1336.3, 1335.8, 716.94, 705.76]
  resolution: [1400, 1400]
)";
inline const char* const kKalibrPinhole = R"(cam0:
  camera_model: pinhole
  distortion_coeffs: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
  distortion_model: radtan
  intrinsics: [458.654, 457.296, 367.215, 248.375]
  resolution: [752, 480]
)";
inline const char* const kRosPinhole = R"(image_width: 752
image_height: 480
camera_name: left
camera_matrix:
  rows: 3
  cols: 3
  data: [458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";
inline const char* const kCamOdoCalPinhole = R"(%YAML:1.0
---
model_type: PINHOLE
camera_name: left
image_width: 752
image_height: 480
distortion_parameters:
   k1: -0.28340811
   k2: 0.07395907
   p1: 0.00019359
   p2: 1.76187114e-05
projection_parameters:
   fx: 458.654
   fy: 457.296
   cx: 367.215
   cy: 248.375
)";

}  // namespace roadbook::test
