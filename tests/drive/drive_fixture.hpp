#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/random.hpp"
#include "drive/check.hpp"
#include "drive/drive.hpp"
#include "drive/writer.hpp"

namespace roadbook::test {

namespace fs = std::filesystem;

/// A temporary folder that the destructor removes.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "roadbook_drive_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

inline std::string read_text(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void write_text(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  fs::remove(file);  // some file systems wait for the disk where a file is cut to nothing
  std::ofstream(file, std::ios::binary) << text;
}

inline cv::Mat noise_image(int width, int height, std::uint64_t seed) {
  Random random(seed, "noise image");
  cv::Mat image(height, width, CV_8UC1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(256));
  return image;
}

inline constexpr std::int64_t kStart = 1'403'636'579'763'555'584;  // 19 digits: no double holds it
inline constexpr std::int64_t kFrame = 80'000'000;
inline constexpr int kFrames = 25;

inline Rig small_rig() {
  Rig rig;
  for (int i = 0; i < 2; ++i) {
    MountedCamera camera;
    camera.name = "cam" + std::to_string(i);
    camera.camera.model = i == 0 ? CameraModel::kKannalaBrandt : CameraModel::kOmni;
    camera.camera.width = 16;
    camera.camera.height = 12;
    camera.camera.max_angle_rad = i == 0 ? 1.7 : 3.14159265358979;
    if (i == 0)
      camera.camera.parameters = {10.1, 10.2, 7.5, 5.5, 0.01, -0.002, 0.0003, 0.1};
    else
      camera.camera.parameters = {1.1, 10.1, 10.2, 7.5, 5.5, 0.01, -0.002, 0.0003, 0.1};
    const Eigen::Quaterniond forward((Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());
    camera.T_vehicle_camera = Eigen::Translation3d(1.0, 0.1 * i, 1.5) * forward *
                              Eigen::AngleAxisd(0.3 + i, Eigen::Vector3d(1, 2, 3).normalized());
    camera.time_offset_s = 0.001 * i;
    rig.cameras.push_back(camera);
  }
  return rig;
}

inline WheelModel small_wheels() {
  WheelModel wheels;
  wheels.radius_left_m = 0.301;
  wheels.radius_right_m = 0.299;
  return wheels;
}

inline TimedPose pose_at(int i) {
  TimedPose pose;
  pose.t_ns = kStart + i * kFrame;
  pose.T_world_vehicle = Eigen::Translation3d(0.1 * i, -0.3 * i, 1.0 / 3.0) *
                         Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d(3, 1, 2).normalized());
  return pose;
}

inline WheelReading wheels_at(int i) {
  return {kStart + i * kFrame / 4, i / 3.0, i / 3.1,
          i % 5 == 4 ? std::nullopt : std::optional(0.1 / (i + 1))};
}

/// A drive of two cameras, wheels, IMU, friction and truth, without a fault.
inline fs::path write_small_drive(const fs::path& folder) {
  DriveWriterOptions options;
  options.comment = "a \"small\" drive";
  options.camera_rate_hz = 12.5;
  options.wheel_rate_hz = 50;
  DriveWriter writer(folder, small_rig(), small_wheels(), options);
  std::vector<TimedPose> truth;
  for (int i = 0; i < kFrames; ++i) {
    for (std::size_t c = 0; c < 2; ++c)
      writer.write_image(c, kStart + i * kFrame,
                         noise_image(16, 12, static_cast<std::uint64_t>(i) * 2 + c));
    truth.push_back(pose_at(i));
    writer.write_imu({kStart + i * kFrame, {0.1 * i, 0.2, 0.3}, {0.4, 0.5, 9.81}});
    writer.write_friction({kStart + i * kFrame, 0.8, 0.05 + i});
  }
  for (int i = 0; i < 4 * kFrames; ++i) writer.write_wheels(wheels_at(i));
  writer.write_segmentation(1, kStart, noise_image(16, 12, 99));
  writer.write_truth(truth);
  writer.finish();
  return folder;
}

/// The lines of a report that contain `text`.
inline std::vector<std::string> lines_with(const DriveReport& report, const std::string& text) {
  std::vector<std::string> lines;
  for (const auto& problem : report.problems)
    if (const auto line = to_line(problem); line.find(text) != std::string::npos)
      lines.push_back(line);
  return lines;
}

inline std::string all_lines(const DriveReport& report) {
  std::string text;
  for (const auto& problem : report.problems) text += to_line(problem) + "\n";
  return text;
}

}  // namespace roadbook::test
