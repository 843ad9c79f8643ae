#include "sensors/camera_effects.hpp"

namespace roadbook {

MountedCamera apply_camera_effects(const MountedCamera& nominal, const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, nominal.name, effect); };
  MountedCamera real = nominal;
  auto& q = real.camera.parameters;
  const std::size_t focal = nominal.camera.model == CameraModel::kOmni           ? 1
                            : nominal.camera.model == CameraModel::kDoubleSphere ? 2
                                                                                 : 0;
  for (std::size_t i = focal; i < focal + 2; ++i) q[i] *= 1.0 + size("focal");
  for (std::size_t i = focal + 2; i < focal + 4; ++i) q[i] += size("centre");
  const bool double_sphere = nominal.camera.model == CameraModel::kDoubleSphere;
  q[double_sphere ? 1 : focal + 4] += size("distortion");
  const auto turn = [&](const char* effect, const Eigen::Vector3d& axis) {
    real.T_vehicle_camera.linear() *= Eigen::AngleAxisd(size(effect), axis).toRotationMatrix();
  };
  turn("rotation", Eigen::Vector3d::UnitY());
  turn("pitch", Eigen::Vector3d::UnitX());
  turn("roll", Eigen::Vector3d::UnitZ());
  real.T_vehicle_camera.translation().x() += size("position");
  return real;
}

}  // namespace roadbook
