#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "base/yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"
#include "sensors/calibration/calibration_io.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMaxBytes = 64u << 20;
constexpr double kUnitTolerance = 1e-3;

// JSON is YAML in flow style, and the YAML reader knows the line of every value, which the JSON
// library does not; that one only judges the grammar.
YamlMap load_json(const std::filesystem::path& file) {
  std::string text = read_regular_file(file, "JSON", kMaxBytes);
  try {
    // Discarding everything keeps the parser's memory small.
    [[maybe_unused]] const auto discarded = nlohmann::json::parse(
        text, [](int, nlohmann::json::parse_event_t, nlohmann::json&) { return false; });
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw BadInput({Severity::kError, file.string(), 1 + std::count(text.begin(), end, '\n'), "",
                    "invalid JSON", "JSON"});
  } catch (const nlohmann::json::exception& error) {  // a number beyond double's range
    throw BadInput({Severity::kError, file.string(), 0, "", error.what(), "JSON"});
  }
  std::replace(text.begin(), text.end(), '\t', ' ');  // YAML forbids them as indentation
  return YamlMap::parse(text, file.string());
}

Eigen::Isometry3d read_quaternion_pose(YamlMap& yaml) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  yaml.require("px", p.x());
  yaml.require("py", p.y());
  yaml.require("pz", p.z());
  yaml.require("qx", q.x());
  yaml.require("qy", q.y());
  yaml.require("qz", q.z());
  yaml.require("qw", q.w());
  if (!(std::abs(q.norm() - 1.0) <= kUnitTolerance)) {
    std::ostringstream length;
    length << "a quaternion of length " << q.norm();
    yaml.report("qx", length.str(), "length 1");
    return Eigen::Isometry3d::Identity();
  }
  return Eigen::Translation3d(p) * q.normalized();
}

void require_in_order(YamlMap& yaml, std::span<const char* const> names, double* values) {
  for (std::size_t i = 0; i < names.size(); ++i) yaml.require(names[i], values[i]);
}

// ucm: fx x / (alpha d + (1 - alpha) z) is omni with xi = alpha / (1 - alpha), f / (1 - alpha).
void read_ucm(YamlMap& yaml, Camera& camera, double* fu_fv_cu_cv) {
  double alpha = 0.0;
  camera.model = CameraModel::kOmni;
  if (!yaml.require("alpha", alpha, Range{0.0, 1.0 - 1e-6})) return;
  camera.parameters[0] = alpha / (1.0 - alpha);
  fu_fv_cu_cv[0] /= 1.0 - alpha;
  fu_fv_cu_cv[1] /= 1.0 - alpha;
}

void read_lens(YamlMap& yaml, Camera& camera) {
  constexpr std::array kFocal{"fx", "fy", "cx", "cy"};
  constexpr std::array kKannalaBrandt{"k1", "k2", "k3", "k4"};
  constexpr std::array kDoubleSphere{"xi", "alpha"};
  std::string type;
  const bool typed = yaml.require("camera_type", type);
  auto numbers = yaml.map("intrinsics");
  if (!typed) return;
  if (type != "ds" && type != "kb4" && type != "ucm" && type != "pinhole") {
    yaml.report("camera_type", type, "ds, kb4, ucm or pinhole");
    if (numbers)
      for (const auto& key : numbers->keys()) numbers->ignore(key);
    return;
  }
  if (!numbers) {
    if (!yaml.has("intrinsics")) yaml.report("intrinsics", "nothing", "this key");
    return;
  }
  std::array<double, 4> focal{1.0, 1.0, 0.0, 0.0};
  require_in_order(*numbers, kFocal, focal.data());
  if (type == "ds") {
    camera.model = CameraModel::kDoubleSphere;
    require_in_order(*numbers, kDoubleSphere, camera.parameters.data());
  } else if (type == "kb4") {
    camera.model = CameraModel::kKannalaBrandt;
    require_in_order(*numbers, kKannalaBrandt, camera.parameters.data() + 4);
  } else if (type == "ucm") {
    read_ucm(*numbers, camera, focal.data());
  }
  set_focal_and_centre(*numbers, "fx", focal.data(), camera);
}

void read_sizes(YamlMap& yaml, std::vector<MountedCamera>& cameras) {
  std::vector<std::vector<double>> sizes;
  if (!yaml.require("resolution", sizes)) return;
  const auto whole = [](double v) { return v >= 1.0 && v <= 1e6 && v == std::floor(v); };
  const bool good = sizes.size() == cameras.size() &&
                    std::all_of(sizes.begin(), sizes.end(), [&](const auto& size) {
                      return size.size() == 2 && whole(size[0]) && whole(size[1]);
                    });
  if (!good)
    return yaml.report("resolution", std::to_string(sizes.size()) + " entries",
                       "width and height, whole and positive, of each camera");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    cameras[i].camera.width = static_cast<int>(sizes[i][0]);
    cameras[i].camera.height = static_cast<int>(sizes[i][1]);
  }
}

}  // namespace

Calibration read_basalt_calibration(const std::filesystem::path& file) {
  YamlMap root = load_json(file);
  auto yaml = root.map("value0");
  if (!yaml) {
    if (!root.has("value0")) root.report("value0", "nothing", "Basalt's calibration");
    root.finish();
  }
  Calibration result;
  result.frame = CalibrationFrame::kBody;
  std::int64_t offset_ns = 0;
  yaml->read("cam_time_offset_ns", offset_ns, Range{-1e10, 1e10});
  for (auto& lens : yaml->maps("intrinsics")) {
    MountedCamera& camera = result.rig.cameras.emplace_back();
    camera.name = "cam" + std::to_string(result.rig.cameras.size() - 1);
    camera.time_offset_s = 1e-9 * static_cast<double>(offset_ns);
    read_lens(lens, camera.camera);
  }
  auto& cameras = result.rig.cameras;
  auto poses = yaml->maps("T_imu_cam");
  if (cameras.empty() || poses.size() != cameras.size())
    yaml->report(
        "T_imu_cam", std::to_string(poses.size()) + " poses",
        "one for each of the " + std::to_string(cameras.size()) + " cameras, at least one");
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Isometry3d T_body_camera = read_quaternion_pose(poses[i]);
    if (i < cameras.size()) cameras[i].T_vehicle_camera = T_body_camera;
  }
  read_sizes(*yaml, cameras);
  // IMU, vignette and motion capture are of no concern here.
  for (const auto& key : yaml->keys()) yaml->ignore(key);
  root.finish();
  return result;
}

}  // namespace roadbook
