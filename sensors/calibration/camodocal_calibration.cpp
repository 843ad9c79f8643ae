#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "base/yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"
#include "sensors/calibration/calibration_io.hpp"

namespace roadbook {
namespace {

// Numbers of one group ("projection_parameters") by name, in the order given.
void read_group(YamlMap& yaml,
                std::string_view group,
                std::span<const char* const> names,
                double* values) {
  auto inner = yaml.map(group);
  if (!inner) {
    if (!yaml.has(group)) yaml.report(group, "nothing", "this key");
    return;
  }
  for (std::size_t i = 0; i < names.size(); ++i) inner->require(names[i], values[i]);
}

void read_focal_and_centre(YamlMap& yaml, std::span<const char* const> names, Camera& camera) {
  std::array<double, 4> values{1.0, 1.0, 0.0, 0.0};
  read_group(yaml, "projection_parameters", names, values.data());
  set_focal_and_centre(yaml, "projection_parameters", values.data(), camera);
}

void read_model(YamlMap& yaml, Camera& camera) {
  constexpr std::array kRadtan{"k1", "k2", "p1", "p2"};
  constexpr std::array kMirror{"xi"};
  constexpr std::array kMeiFocal{"gamma1", "gamma2", "u0", "v0"};
  constexpr std::array kPinholeFocal{"fx", "fy", "cx", "cy"};
  std::string model;
  if (!yaml.require("model_type", model)) return;
  double* const q = camera.parameters.data();
  if (model == "MEI") {
    camera.model = CameraModel::kOmni;
    read_group(yaml, "mirror_parameters", kMirror, q);
    read_group(yaml, "distortion_parameters", kRadtan, q + 5);
    read_focal_and_centre(yaml, kMeiFocal, camera);
  } else if (model == "KANNALA_BRANDT") {
    camera.model = CameraModel::kKannalaBrandt;
    // Coefficients and focal lengths share one group; k1 is 1: r = theta + k2 theta^3 + ...
    constexpr std::array kAll{"mu", "mv", "u0", "v0", "k2", "k3", "k4", "k5"};
    read_group(yaml, "projection_parameters", kAll, q);
    set_focal_and_centre(yaml, "projection_parameters", q, camera);
  } else if (model == "PINHOLE") {
    camera.model = CameraModel::kPinholeRadtan;
    read_group(yaml, "distortion_parameters", kRadtan, q + 4);
    read_focal_and_centre(yaml, kPinholeFocal, camera);
  } else {
    yaml.report("model_type", model, "MEI, KANNALA_BRANDT or PINHOLE");
  }
}

}  // namespace

Calibration read_camodocal_calibration(const std::filesystem::path& file) {
  YamlMap yaml = YamlMap::load(file);
  Calibration result;
  MountedCamera& mounted = result.rig.cameras.emplace_back();
  mounted.name = "cam0";
  yaml.read("camera_name", mounted.name);
  yaml.require("image_width", mounted.camera.width, kImageSide);
  yaml.require("image_height", mounted.camera.height, kImageSide);
  read_model(yaml, mounted.camera);
  yaml.finish();
  return result;
}

}  // namespace roadbook
