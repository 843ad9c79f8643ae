#pragma once

#include <filesystem>
#include <opencv2/core/persistence.hpp>
#include <string>

#include "base/se3.hpp"
#include "sensors/rig.hpp"

// Cameras of two published data sets with four fisheyes around a car, with the authors'
// calibration.

namespace roadbook::test {

inline Eigen::MatrixXd matrix(const cv::FileStorage& file, const std::string& name) {
  cv::Mat values;
  file[name] >> values;
  Eigen::MatrixXd m(values.rows, values.cols);
  for (int r = 0; r < m.rows(); ++r)
    for (int c = 0; c < m.cols(); ++c) m(r, c) = values.at<double>(r, c);
  return m;
}

inline Camera fisheye(const Eigen::MatrixXd& K,
                      const Eigen::MatrixXd& k,
                      int width,
                      int height,
                      double max_angle_rad) {
  Camera camera;
  camera.model = CameraModel::kKannalaBrandt;
  camera.parameters = {K(0, 0), K(1, 1), K(0, 2), K(1, 2), k(0), k(1), k(2), k(3)};
  camera.width = width;
  camera.height = height;
  camera.max_angle_rad = max_angle_rad;
  return camera;
}

// oecs_surround: p_cam = R p_ground + t, ground x right, y forward, t in decimetres.
inline MountedCamera oecs_camera(const std::filesystem::path& yaml, const std::string& name) {
  const cv::FileStorage file(yaml.string(), cv::FileStorage::READ);
  const Eigen::MatrixXd K = matrix(file, "camera_matrix");
  const Eigen::MatrixXd k = matrix(file, "dist_coeffs");
  MountedCamera mounted;
  mounted.name = name;
  mounted.camera = fisheye(K, k, 1280, 1080, 1.5);
  Eigen::Isometry3d T_camera_ground = Eigen::Isometry3d::Identity();
  T_camera_ground.linear() = nearest_rotation(matrix(file, "R_cam_ground"));
  T_camera_ground.translation() = 0.1 * matrix(file, "t_cam_ground");
  Eigen::Isometry3d T_ground_vehicle = Eigen::Isometry3d::Identity();
  T_ground_vehicle.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  mounted.T_vehicle_camera = (T_camera_ground * T_ground_vehicle).inverse();
  return mounted;
}

// surround4_neozhao gives no poses. It gives homographies from the undistorted image to a
// bird's-eye view of 1200 x 1600 px of 1 cm, each in the orientation of its camera. The car is in
// the middle of this view and points up. This matrix converts metres on the ground (x forward, y
// left) to pixels of the view:
inline Eigen::Matrix3d view_from_ground(const std::string& name) {
  Eigen::Matrix3d to_whole;  // column 600 - 100 y, row 800 - 100 x
  to_whole << 0, -100, 600, -100, 0, 800, 0, 0, 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  if (name == "back") turn << -1, 0, 1199, 0, -1, 1599, 0, 0, 1;
  if (name == "left") turn << 0, -1, 1599, 1, 0, 0, 0, 0, 1;
  if (name == "right") turn << 0, 1, 0, -1, 0, 1199, 0, 0, 1;
  return turn * to_whole;
}

struct PosedCamera {
  MountedCamera mounted;
  double scale_ratio = 1.0;  ///< of the two axes of the ground: 1 if the camera sees a plane
  double cosine = 0.0;       ///< between them: 0
};

inline PosedCamera neozhao_camera(const std::filesystem::path& data, const std::string& name) {
  const cv::FileStorage file((data / "yaml" / (name + ".yaml")).string(), cv::FileStorage::READ);
  const Eigen::MatrixXd K = matrix(file, "camera_matrix");
  const Eigen::MatrixXd k = matrix(file, "dist_coeffs");
  cv::Mat scale;
  cv::Mat shift;
  file["scale_xy"] >> scale;
  file["shift_xy"] >> shift;
  PosedCamera posed;
  MountedCamera& mounted = posed.mounted;
  mounted.name = name;
  mounted.camera = fisheye(K, k, 960, 640, 1.4);
  Eigen::Matrix3d undistorted = K;  // the pinhole that the set's authors undistort to
  undistorted(0, 0) *= static_cast<double>(scale.at<float>(0));
  undistorted(1, 1) *= static_cast<double>(scale.at<float>(1));
  undistorted(0, 2) += static_cast<double>(shift.at<float>(0));
  undistorted(1, 2) += static_cast<double>(shift.at<float>(1));
  // Columns r1, r2, t of the pose, up to a common factor (Zhang 2000, section 3.1).
  Eigen::Matrix3d P = undistorted.inverse() *
                      Eigen::Matrix3d(matrix(file, "project_matrix")).inverse() *
                      view_from_ground(name);
  // The ground of the view lies in front of the camera. The test point is two metres ahead of the
  // camera's side of the car.
  const Eigen::Vector3d ahead = name == "front"  ? Eigen::Vector3d(4.5, 0, 1)
                                : name == "back" ? Eigen::Vector3d(-4.5, 0, 1)
                                : name == "left" ? Eigen::Vector3d(0, 3, 1)
                                                 : Eigen::Vector3d(0, -3, 1);
  P /= std::copysign(std::sqrt(P.col(0).norm() * P.col(1).norm()), (P * ahead).z());
  posed.scale_ratio = P.col(0).norm() / P.col(1).norm();
  posed.cosine = P.col(0).normalized().dot(P.col(1).normalized());
  Eigen::Matrix3d R;
  R << P.col(0), P.col(1), P.col(0).cross(P.col(1));
  Eigen::Isometry3d T_camera_ground = Eigen::Isometry3d::Identity();
  T_camera_ground.linear() = nearest_rotation(R);
  T_camera_ground.translation() = P.col(2);
  mounted.T_vehicle_camera = T_camera_ground.inverse();
  return posed;
}

}  // namespace roadbook::test
