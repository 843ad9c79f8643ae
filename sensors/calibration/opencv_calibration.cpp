#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"
#include "sensors/calibration/calibration_io.hpp"

namespace roadbook {
namespace {

void read_camera_matrix(YamlMap& yaml, Camera& camera) {
  constexpr std::string_view kKey = "camera_matrix";
  if (!yaml.has(kKey)) return yaml.report(kKey, "nothing", "this key");
  const MatrixField K = read_matrix(yaml, kKey);
  if (K.numbers.empty()) return;
  if (K.rows != 3 || K.cols != 3)
    return yaml.report(kKey, std::to_string(K.rows) + "x" + std::to_string(K.cols), "3x3");
  const auto& k = K.numbers;
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    return yaml.report(kKey, "another matrix", "fu 0 cu, 0 fv cv, 0 0 1 (no skew)");
  const std::array<double, 4> fu_fv_cu_cv{k[0], k[4], k[2], k[5]};
  set_focal_and_centre(yaml, kKey, fu_fv_cu_cv.data(), camera);
}

// OpenCV's files do not name the model; ROS' do, and people add it to both.
std::string stated_model(YamlMap& yaml) {
  std::string model;
  for (const char* const key : {"distortion_model", "camera_model"}) {
    if (!model.empty() || !yaml.read(key, model)) continue;
    if (model == "fisheye" || model == "equidistant")
      model = "equidistant";
    else if (model == "plumb_bob" || model == "radtan" || model == "radial-tangential")
      model = "radtan";
    else if (model == "pinhole")
      model.clear();  // says nothing of the distortion
    else {
      yaml.report(key, model, "fisheye, equidistant, plumb_bob or radtan");
      model = "unknown";
    }
  }
  return model;
}

void read_distortion(YamlMap& yaml, Camera& camera) {
  const std::string model = stated_model(yaml);
  const std::string key =
      yaml.has("distortion_coefficients") ? "distortion_coefficients" : "dist_coeffs";
  if (!yaml.has(key)) return yaml.report(key, "nothing", "this key");
  const MatrixField D = read_matrix(yaml, key);
  const std::size_t count = D.numbers.size();
  if (count == 0) return;
  const bool vector = D.rows == 1 || D.cols == 1;
  if (!vector || count < 4 || count > 14)
    return yaml.report(key, std::to_string(D.rows) + "x" + std::to_string(D.cols),
                       "4 to 14 coefficients in a row or a column");
  const bool fisheye = model.empty() ? count == 4 : model == "equidistant";
  camera.model = fisheye ? CameraModel::kKannalaBrandt : CameraModel::kPinholeRadtan;
  if (std::any_of(D.numbers.begin() + 4, D.numbers.end(), [](double k) { return k != 0.0; }))
    return yaml.report(key, "more than four coefficients that are not 0",
                       "k1 k2 p1 p2, then zeros");
  std::copy_n(D.numbers.begin(), 4, camera.parameters.begin() + 4);
}

void read_size(YamlMap& yaml, Camera& camera) {
  if (yaml.has("resolution")) {
    const MatrixField size = read_matrix(yaml, "resolution");
    if (size.numbers.empty()) return;
    const auto whole = [](double v) { return v >= 1.0 && v <= 1e6 && v == static_cast<int>(v); };
    if (size.numbers.size() != 2 || !whole(size.numbers[0]) || !whole(size.numbers[1]))
      return yaml.report("resolution", std::to_string(size.numbers.size()) + " numbers",
                         "width and height, whole and positive");
    camera.width = static_cast<int>(size.numbers[0]);
    camera.height = static_cast<int>(size.numbers[1]);
    return;
  }
  yaml.read("image_width", camera.width, kImageSide);
  yaml.read("image_height", camera.height, kImageSide);
  if ((camera.width > 0) != (camera.height > 0))
    yaml.report("image_height", "one side of the image", "image_width and image_height");
}

}  // namespace

Calibration read_opencv_calibration(const std::filesystem::path& file) {
  YamlMap yaml = YamlMap::load(file);
  Calibration result;
  MountedCamera& mounted = result.rig.cameras.emplace_back();
  mounted.name = "cam0";
  yaml.read("camera_name", mounted.name);
  read_camera_matrix(yaml, mounted.camera);
  read_distortion(yaml, mounted.camera);
  read_size(yaml, mounted.camera);
  // Programs add their own results to an OpenCV file: ground homographies, errors, dates.
  for (const auto& key : yaml.keys()) yaml.ignore(key);
  yaml.finish();
  return result;
}

}  // namespace roadbook
