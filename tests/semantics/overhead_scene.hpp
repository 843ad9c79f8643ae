#pragma once

#include <gdal_priv.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <opencv2/core.hpp>
#include <string>

#include "semantics/overhead/overhead.hpp"

namespace roadbook::test {

// Renders a painted ground through fisheyes. The renderer is independent of the mosaic: it goes
// from pixels to the ground through Camera::bearing, and the mosaic goes the other way.

struct PaintedGround {
  double hinge_y_m = 1e9;  ///< y at which the floor begins to rise
  double hinge_slope = 0.0;
  std::function<double(double x, double y)> grey;

  [[nodiscard]] double height(double y) const {
    return y > hinge_y_m ? (y - hinge_y_m) * hinge_slope : 0.0;
  }
};

/// White lines 10 cm wide: along x at y = -6, -3, 3, 6; across at every 2 m of x.
inline double lines(double x, double y) {
  const auto line = [](double distance) {  // edge softened over 1 cm
    return std::clamp((0.055 - std::abs(distance)) / 0.01, 0.0, 1.0);
  };
  double paint = std::max(line(std::abs(y) - 3.0), line(std::abs(y) - 6.0));
  paint = std::max(paint, line(x - 2.0 * std::round(x / 2.0)));
  return 80.0 + 120.0 * paint;
}

inline Rig four_fisheyes(int width = 480, int height = 360) {
  Rig rig;
  const double pitch = 0.6;  // down
  for (int i = 0; i < 4; ++i) {
    const double yaw = i * M_PI / 2;
    Eigen::Matrix3d looking;  // columns: camera axes of an upright camera that looks along x
    looking << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    MountedCamera mounted;
    mounted.name = "cam" + std::to_string(i);
    mounted.camera.model = CameraModel::kKannalaBrandt;
    const double f = width / 3.2;
    mounted.camera.parameters = {f,   f,  0.5 * (width - 1), 0.5 * (height - 1), 0.01, -0.002,
                                 0.0, 0.0};
    mounted.camera.width = width;
    mounted.camera.height = height;
    mounted.camera.max_angle_rad = 1.6;
    mounted.T_vehicle_camera.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))
                                            .toRotationMatrix() *
                                        looking;
    // On the outside of the car: front, left, back, right.
    const Eigen::Vector3d places[] = {
        {3.9, 0, 0.8}, {1.8, 1.0, 1.0}, {-1.1, 0, 0.9}, {1.8, -1.0, 1.0}};
    mounted.T_vehicle_camera.translation() = places[i];
    rig.cameras.push_back(mounted);
  }
  return rig;
}

inline cv::Mat render(const MountedCamera& mounted,
                      const Eigen::Isometry3d& T_map_vehicle,
                      const PaintedGround& ground) {
  const Eigen::Isometry3d T = T_map_vehicle * mounted.T_vehicle_camera;
  const Eigen::Vector3d c = T.translation();
  cv::Mat image(mounted.camera.height, mounted.camera.width, CV_8UC1, cv::Scalar(30));
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const auto bearing = mounted.camera.bearing({u, v});
      if (!bearing) continue;
      const Eigen::Vector3d ray = T.linear() * *bearing;
      double t = ray.z() < -1e-6 ? -c.z() / ray.z() : -1.0;  // on the flat part
      if (t < 0 || c.y() + t * ray.y() > ground.hinge_y_m) {
        // Beyond the hinge: z = (y - hinge) slope.
        const double closing = ray.y() * ground.hinge_slope - ray.z();
        t = closing > 1e-6 ? (c.z() - (c.y() - ground.hinge_y_m) * ground.hinge_slope) / closing
                           : -1.0;
        if (t > 0 && c.y() + t * ray.y() < ground.hinge_y_m) t = -1.0;
      }
      if (t <= 0 || t > 60) continue;
      const double grey = ground.grey(c.x() + t * ray.x(), c.y() + t * ray.y());
      image.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(std::lround(grey));
    }
  }
  return image;
}

/// A drive along x with a view every `spacing` metres. Each image is rendered once.
inline OverheadInput drive_over(const PaintedGround& ground, int views, double spacing) {
  OverheadInput input;
  input.rigs = {four_fisheyes()};
  input.bodies.emplace_back(Eigen::Vector3d(-1.0, -0.95, 0.0), Eigen::Vector3d(3.8, 0.95, 1.6));
  for (int i = 0; i < views; ++i) {
    OverheadView view;
    view.T_map_vehicle.translation() = Eigen::Vector3d(i * spacing, 0.3, 0.0);
    view.T_map_vehicle.linear() =
        Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    view.keyframe = i;
    view.t_ns = 1'000'000'000LL * i;
    for (const MountedCamera& mounted : input.rigs[0].cameras) {
      const cv::Mat image = render(mounted, view.T_map_vehicle, ground);
      view.images.emplace_back([image] { return image; });
    }
    input.views.push_back(std::move(view));
  }
  return input;
}

/// One band of a GeoTIFF as doubles.
inline cv::Mat_<double> read_band(const std::filesystem::path& path, int band = 1) {
  GDALAllRegister();
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_ReadOnly));
  if (dataset == nullptr) return {};
  cv::Mat_<double> values(dataset->GetRasterYSize(), dataset->GetRasterXSize());
  const CPLErr error =
      dataset->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, values.cols, values.rows, values.data,
                                             values.cols, values.rows, GDT_Float64, 0, 0);
  GDALClose(dataset);
  return error == CE_None ? values : cv::Mat_<double>{};
}

/// A folder that is removed at the end of the test.
class Scratch {
 public:
  explicit Scratch(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("roadbook_overhead_" + name + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() { std::filesystem::remove_all(path_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline OverheadOptions quick_overhead() {
  OverheadOptions options;
  options.max_range_m = 7.0;
  return options;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace roadbook::test
