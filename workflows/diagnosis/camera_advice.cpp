#include "workflows/diagnosis/camera_advice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "base/format.hpp"
#include "sensors/camera_effects.hpp"

namespace roadbook {
namespace {

// The key of `sensor.yaml` that an effect changes.
struct Key {
  std::string_view effect;
  std::string_view key;
};
constexpr std::string_view kIntrinsics = "intrinsics";
constexpr std::string_view kDistortion = "distortion_coefficients";
constexpr std::string_view kMounting = "T_BS";
constexpr std::string_view kShutter = "rolling_shutter";
constexpr std::array kKeys{
    Key{"focal", kIntrinsics},       Key{"aspect", kIntrinsics},   Key{"centre", kIntrinsics},
    Key{"centre_x", kIntrinsics},    Key{"centre_y", kIntrinsics}, Key{"distortion", kDistortion},
    Key{"distortion2", kDistortion}, Key{"rotation", kMounting},   Key{"pitch", kMounting},
    Key{"roll", kMounting},          Key{"position", kMounting},   Key{"lateral", kMounting},
    Key{"height", kMounting},        Key{kShutter, kShutter}};

// Pinhole cameras state four intrinsics, omni five; double sphere states all and no distortion.
std::size_t intrinsics_of(CameraModel model) {
  constexpr std::size_t kPinhole = 4, kOmni = 5, kDoubleSphere = 6;
  if (model == CameraModel::kDoubleSphere) return kDoubleSphere;
  return model == CameraModel::kOmni ? kOmni : kPinhole;
}

std::vector<double> values_of(const MountedCamera& camera, std::string_view key) {
  const auto first = camera.camera.parameters.begin();
  const auto middle = first + static_cast<std::ptrdiff_t>(intrinsics_of(camera.camera.model));
  if (key == kIntrinsics) return {first, middle};
  if (key == kShutter) return {camera.rolling_shutter_s};
  if (key == kDistortion) return {middle, first + parameter_count(camera.camera.model)};
  std::vector<double> rows;
  for (Eigen::Index row = 0; row < 4; ++row)
    for (Eigen::Index column = 0; column < 4; ++column)
      rows.push_back(camera.T_vehicle_camera.matrix()(row, column));
  return rows;
}

std::string row_text(const std::vector<double>& values) {
  constexpr int kPixelDigits = 2, kFineDigits = 5;
  constexpr double kSmall = 20.0;  // pixels are larger, metres and coefficients smaller
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "[" : ", ") +
            fixed(value, std::abs(value) < kSmall ? kFineDigits : kPixelDigits);
  return values.size() == 1 ? text.substr(1) : text + "]";
}

}  // namespace

std::optional<std::string> new_camera_values(const Diagnosis& d,
                                             const std::string& effect,
                                             const Rig& stated) {
  const auto dot = effect.find('.');
  const std::string name = effect.substr(0, dot);
  const auto camera = std::find_if(stated.cameras.begin(), stated.cameras.end(),
                                   [&](const MountedCamera& c) { return c.name == name; });
  const auto* const found = std::find_if(
      kKeys.begin(), kKeys.end(), [&](const Key& k) { return k.effect == effect.substr(dot + 1); });
  if (camera == stated.cameras.end() || found == kKeys.end()) return std::nullopt;
  // Double sphere has no distortion coefficients: its first intrinsics bend the rays.
  const bool double_sphere = camera->camera.model == CameraModel::kDoubleSphere;
  const std::string_view key =
      double_sphere && found->key == kDistortion ? kIntrinsics : found->key;
  EffectSizes own;
  for (const auto& [known, size] : d.extended)  // with what a given model says
    if (known.starts_with(name + ".")) own[known] = size;
  const MountedCamera now = apply_camera_effects(*camera, own);
  return "set `" + std::string(key) + "` of " + name + " to " + row_text(values_of(now, key)) +
         " (stated: " + row_text(values_of(*camera, key)) + ")";
}

}  // namespace roadbook
