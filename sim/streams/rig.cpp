#include "sim/streams/rig.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "sensors/camera_effects.hpp"

namespace roadbook {
namespace {

/// A camera at `place` that looks along `heading`, turned down by `tilt`.
Eigen::Isometry3d mounted(const Eigen::Vector3d& place, double heading, double tilt, double roll) {
  // Level and ahead: the camera's x is the vehicle's -y, its y is -z, its z is x.
  Eigen::Matrix3d level;
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix() * level *
               Eigen::AngleAxisd(-tilt, Eigen::Vector3d::UnitX()).toRotationMatrix() *
               Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = place;
  return T;
}

}  // namespace

Rig make_rig(const CameraSpec& spec) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const double scale = spec.width / 1280.0;
  const std::array<Eigen::Isometry3d, 4> mounts{
      mounted({3.49, 0.02, 0.66}, 0.004, 0.33, 0.003),
      mounted({1.72, 0.98, 0.96}, kQuarter - 0.01, 0.40, -0.006),
      mounted({-0.80, -0.03, 0.86}, 2.0 * kQuarter + 0.006, 0.36, 0.004),
      mounted({1.71, -0.98, 0.97}, -kQuarter + 0.008, 0.39, 0.005)};
  Rig rig;
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    MountedCamera mount;
    mount.name = "cam" + std::to_string(i);
    Camera& camera = mount.camera;
    camera.model = CameraModel::kKannalaBrandt;
    camera.width = spec.width;
    camera.height = spec.height;
    // No two lenses are the same.
    const double d = static_cast<double>(i);
    const double f = (412.0 + 0.8 * d) * scale;
    const auto middle = [&](double size, double shift) { return 0.5 * size - 0.5 + shift * scale; };
    camera.parameters = {f,
                         f * (1.0005 - 0.0003 * d),
                         middle(spec.width, 3.1 - 2.3 * d),
                         middle(spec.height, -2.2 + 1.7 * d),
                         -0.012 + 0.001 * d,
                         0.0021,
                         -0.0011,
                         0.00012};
    camera.max_angle_rad = 95.0 * std::numbers::pi / 180.0;
    mount.T_vehicle_camera = mounts[i];
    rig.cameras.push_back(mount);
  }
  return rig;
}

RealCamera real_camera(const MountedCamera& nominal, const EffectSizes& effects) {
  const auto size = [&](const char* effect) { return effect_size(effects, nominal.name, effect); };
  RealCamera real;
  const MountedCamera turned = apply_camera_effects(nominal, effects);
  real.camera = turned.camera;
  real.T_vehicle_camera = turned.T_vehicle_camera;
  real.latency_s = size("latency");
  real.rolling_shutter_s = turned.rolling_shutter_s;
  real.vignetting = size("vignetting");
  real.gain = 1.0 + size("exposure");
  real.later_gain = 1.0 + size("exposure_step");
  return real;
}

}  // namespace roadbook
