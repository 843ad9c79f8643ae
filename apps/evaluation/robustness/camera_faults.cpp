#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "apps/evaluation/robustness/drive_fault.hpp"
#include "apps/evaluation/robustness/recorded_table.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr int kCameras = 4;

std::string camera_name(std::uint64_t index) { return "cam" + std::to_string(index); }

std::string drawn_camera(Random& random) { return camera_name(random.below(kCameras)); }

double drawn_sign(Random& random) { return random.below(2) == 0 ? 1.0 : -1.0; }

using CameraChange = std::function<void(const fs::path& camera, Random&)>;

DriveFault one_camera(const std::string& name,
                      const std::vector<std::string>& causes,
                      const CameraChange& change) {
  return {"camera: " + name, [=](const fs::path& drive, Random& random) {
            const std::string camera = drawn_camera(random);
            change(drive / camera, random);
            return PlantedFault{{camera}, causes};
          }};
}

DriveFault all_cameras(const std::string& name, const CameraChange& change) {
  return {"cameras: " + name, [=](const fs::path& drive, Random& random) {
            PlantedFault planted;
            for (std::uint64_t i = 0; i < kCameras; ++i) {
              change(drive / camera_name(i), random);
              planted.sensors.push_back(camera_name(i));
            }
            return planted;
          }};
}

Eigen::Isometry3d mount_of(const fs::path& yaml) {
  const std::vector<double> n = numbers_of(value_of(yaml, "data"));
  Eigen::Isometry3d T;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      T.matrix()(row, column) = n.at(static_cast<std::size_t>(4 * row + column));
  return T;
}

void set_mount(const fs::path& yaml, const Eigen::Isometry3d& T) {
  std::vector<double> n;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) n.push_back(T.matrix()(row, column));
  set_value(yaml, "data", list_of(n));
}

void scale_focal(const fs::path& camera, Random& random) {
  std::vector<double> n = numbers_of(value_of(camera / "sensor.yaml", "intrinsics"));
  const double factor = 1.0 + 0.02 * drawn_sign(random);
  n.at(0) *= factor;
  n.at(1) *= factor;
  set_value(camera / "sensor.yaml", "intrinsics", list_of(n));
}

void double_intrinsics(const fs::path& camera, Random&) {
  std::vector<double> n = numbers_of(value_of(camera / "sensor.yaml", "intrinsics"));
  for (double& value : n) value *= 2.0;
  set_value(camera / "sensor.yaml", "intrinsics", list_of(n));
}

void turn(const fs::path& camera, Random& random) {
  constexpr double kTurnRad = 2.0 * std::numbers::pi / 180.0;
  const Eigen::Vector3d axis =
      Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  Eigen::Isometry3d T = mount_of(camera / "sensor.yaml");
  T.rotate(Eigen::AngleAxisd(kTurnRad, axis));
  set_mount(camera / "sensor.yaml", T);
}

void move_away(const fs::path& camera, Random& random) {
  Eigen::Isometry3d T = mount_of(camera / "sensor.yaml");
  T.pretranslate(Eigen::Vector3d(3500.0 * drawn_sign(random), 0.0, 0.0));
  set_mount(camera / "sensor.yaml", T);
}

void invert(const fs::path& camera, Random&) {
  set_mount(camera / "sensor.yaml", mount_of(camera / "sensor.yaml").inverse());
}

CameraChange late(std::int64_t ns) {
  return [=](const fs::path& camera, Random&) {
    RecordedTable table(camera / "data.csv");
    table.shift_stamps(ns);
    table.write();
  };
}

// From a drawn row on, the recording repeats one image.
void freeze(const fs::path& camera, Random& random) {
  RecordedTable table(camera / "data.csv");
  const std::size_t from = table.rows() / 4 + random.below(table.rows() / 4);
  const std::size_t column = table.column("filename");
  for (std::size_t row = from; row < table.rows(); ++row) {
    const fs::path image = camera / "data" / table.cell(row, column);
    if (row == from) continue;
    fs::remove(image);
    fs::copy_file(camera / "data" / table.cell(from, column), image);
  }
}

// Replaces every image by what `make` makes of it.
CameraChange every_image(const std::function<cv::Mat(const cv::Mat&)>& make) {
  return [=](const fs::path& camera, Random&) {
    for (const auto& entry : fs::directory_iterator(camera / "data")) {
      const cv::Mat image = make(cv::imread(entry.path().string(), cv::IMREAD_UNCHANGED));
      fs::remove(entry.path());  // other names of the file keep the image
      cv::imwrite(entry.path().string(), image);
    }
  };
}

CameraChange one_grey(double grey) {
  return every_image(
      [=](const cv::Mat& image) { return cv::Mat(image.size(), CV_8UC1, cv::Scalar(grey)); });
}

// Greys of 8 bits as `bits` bits in 16-bit images, not scaled.
CameraChange deep(int bits) {
  return every_image([=](const cv::Mat& image) {
    cv::Mat deep;
    image.convertTo(deep, CV_16UC1, static_cast<double>(1 << (bits - 8)));
    return deep;
  });
}

// A wall of grey squares that slides by in front of the right half of every image, as a long lorry
// does: 1 to 4 pixels an image.
void cover_with_moving_things(const fs::path& camera, Random& random) {
  const RecordedTable table(camera / "data.csv");
  const std::size_t column = table.column("filename");
  const int speed_px = 1 + static_cast<int>(random.below(4));
  cv::Mat squares(60, 200, CV_8UC1);
  for (int row = 0; row < squares.rows; ++row)
    for (int i = 0; i < squares.cols; ++i)
      squares.at<std::uint8_t>(row, i) = static_cast<std::uint8_t>(40 + random.below(160));
  cv::Mat wall;
  cv::resize(squares, wall, {}, 8.0, 8.0, cv::INTER_NEAREST);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const fs::path file = camera / "data" / table.cell(row, column);
    cv::Mat image = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
    const int half = image.cols / 2;
    const int shift = speed_px * static_cast<int>(row) % (wall.cols - half);
    cv::Mat part = image(cv::Rect(half, 0, image.cols - half, std::min(image.rows, wall.rows)));
    wall(cv::Rect(shift, 0, part.cols, part.rows)).copyTo(part);
    fs::remove(file);
    cv::imwrite(file.string(), image);
  }
}

DriveFault swapped() {
  return {"cameras: two swapped", [](const fs::path& drive, Random& random) {
            const std::uint64_t a = random.below(kCameras);
            const std::uint64_t b = (a + 1 + random.below(kCameras - 1)) % kCameras;
            const fs::path first = drive / camera_name(a);
            const fs::path second = drive / camera_name(b);
            for (const char* part : {"data", "data.csv"}) {
              fs::rename(first / part, drive / "moving");
              fs::rename(second / part, first / part);
              fs::rename(drive / "moving", second / part);
            }
            return PlantedFault{{camera_name(a), camera_name(b)},
                                {"look exchanged", "fit the calibration of"}};
          }};
}

}  // namespace

std::vector<DriveFault> camera_faults() {
  return {one_camera("focal length 2 % wrong", {"focal length"}, scale_focal),
          one_camera("turned 2 degrees", {"rotation"}, turn),
          swapped(),
          one_camera("3.5 km from the car", {"from the vehicle"}, move_away),
          all_cameras("T_BS inverted", invert),
          all_cameras("intrinsics of twice the size", double_intrinsics),
          one_camera("frozen image", {"repeat"}, freeze),
          one_camera("1 us late", {}, late(1'000)),
          one_camera("20 ms late", {"time_offset"}, late(20'000'000)),
          one_camera("80 ms late", {"time_offset"}, late(80'000'000)),
          all_cameras("moving things over half the view", cover_with_moving_things),
          all_cameras("black", one_grey(0.0)),
          all_cameras("white", one_grey(255.0)),
          all_cameras("12 bits in 16", deep(12)),
          all_cameras("10 bits in 16", deep(10))};
}

}  // namespace roadbook
