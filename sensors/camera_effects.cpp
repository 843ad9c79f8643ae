#include "sensors/camera_effects.hpp"

namespace roadbook {

MountedCamera apply_camera_effects(const MountedCamera& nominal, const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, nominal.name, effect); };
  MountedCamera real = nominal;
  auto& q = real.camera.parameters;
  const std::size_t focal = nominal.camera.model == CameraModel::kOmni           ? 1
                            : nominal.camera.model == CameraModel::kDoubleSphere ? 2
                                                                                 : 0;
  q[focal] *= (1.0 + size("focal")) * (1.0 + 0.5 * size("aspect"));
  q[focal + 1] *= (1.0 + size("focal")) * (1.0 - 0.5 * size("aspect"));
  q[focal + 2] += size("centre") + size("centre_x");
  q[focal + 3] += size("centre") + size("centre_y");
  const bool double_sphere = nominal.camera.model == CameraModel::kDoubleSphere;
  q[double_sphere ? 1 : focal + 4] += size("distortion");
  q[double_sphere ? 0 : focal + 5] += size("distortion2");
  const auto turn = [&](const char* effect, const Eigen::Vector3d& axis) {
    real.T_vehicle_camera.linear() *= Eigen::AngleAxisd(size(effect), axis).toRotationMatrix();
  };
  turn("rotation", Eigen::Vector3d::UnitY());
  turn("pitch", Eigen::Vector3d::UnitX());
  turn("roll", Eigen::Vector3d::UnitZ());
  real.T_vehicle_camera.translation() +=
      Eigen::Vector3d(size("position"), size("lateral"), size("height"));
  const Eigen::Matrix3d turned_rig =
      (Eigen::AngleAxisd(-effect_size(sizes, "rig", "rotation"), Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(-effect_size(sizes, "rig", "pitch"), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(effect_size(sizes, "rig", "roll"), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  // A latency of all cameras is one of the instants.
  const double own_latency = size("latency") - effect_size(sizes, "cam", "latency");
  return {real.name,
          real.camera,
          Eigen::Isometry3d(turned_rig) * real.T_vehicle_camera,
          real.time_offset_s,
          nominal.exposed_after_s - own_latency,
          nominal.rolling_shutter_s + size("rolling_shutter")};
}

}  // namespace roadbook
