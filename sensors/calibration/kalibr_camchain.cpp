#include <optional>
#include <span>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "base/yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"
#include "sensors/calibration/calibration_io.hpp"

namespace roadbook {
namespace {

constexpr double kMaxMegapixels = 1000.0;
// Kalibr writes both poses from one estimate; files typed by hand carry six digits.
constexpr double kChainTolerance = 1e-3;

// One camera of the chain, with the poses as the file states them.
struct Link {
  MountedCamera camera;
  std::optional<Eigen::Isometry3d> T_camera_body;
  std::optional<Eigen::Isometry3d> T_camera_before;
  bool states_time = false;
};

std::optional<Eigen::Isometry3d> read_matrix_pose(YamlMap& yaml, std::string_view key) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  return read_rigid_motion(yaml, key, T) ? std::optional(T) : std::nullopt;
}

Link read_link(YamlMap& yaml, const std::string& name) {
  Link link;
  link.camera.name = name;
  read_kalibr_lens(yaml, "distortion_coeffs", link.camera.camera);
  read_resolution(yaml, kMaxMegapixels, link.camera.camera);
  link.T_camera_body = read_matrix_pose(yaml, "T_cam_imu");
  if (const auto T_body_camera = read_matrix_pose(yaml, "T_imu_cam")) {
    if (link.T_camera_body) yaml.report("T_imu_cam", "both poses", "T_cam_imu or its inverse");
    link.T_camera_body = T_body_camera->inverse();
  }
  link.T_camera_before = read_matrix_pose(yaml, "T_cn_cnm1");
  link.states_time = yaml.has("timeshift_cam_imu");
  yaml.read("timeshift_cam_imu", link.camera.time_offset_s, {-10.0, 10.0});
  for (const char* const key : {"cam_overlaps", "rostopic", "line_delay"}) yaml.ignore(key);
  return link;
}

bool agree(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() <= kChainTolerance;
}

// Resolves the poses of all cameras. In a chain without any body, the first camera is the
// reference.
CalibrationFrame resolve_poses(YamlMap& yaml, std::vector<Link>& links) {
  CalibrationFrame frame = CalibrationFrame::kBody;
  if (!links.empty() && !links.front().T_camera_body) {
    frame = links.size() > 1 ? CalibrationFrame::kFirstCamera : CalibrationFrame::kNone;
    links.front().T_camera_body = Eigen::Isometry3d::Identity();
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    Link& link = links[i];
    const std::string& name = link.camera.name;
    if (i > 0 && frame == CalibrationFrame::kFirstCamera && link.T_camera_body)
      yaml.report(name, "T_cam_imu, which cam0 does not have", "T_cam_imu of every camera or none");
    if (i == 0 && link.T_camera_before)
      yaml.report(name, "T_cn_cnm1", "it only from the second camera on");
    if (i > 0 && link.T_camera_before) {
      const Eigen::Isometry3d chained = *link.T_camera_before * *links[i - 1].T_camera_body;
      if (!link.T_camera_body) link.T_camera_body = chained;
      if (!agree(*link.T_camera_body, chained))
        yaml.report(name, "a T_cn_cnm1 that contradicts T_cam_imu", "the same pose from both");
    }
    if (!link.T_camera_body) {
      yaml.report(name, "no pose", "T_cam_imu or T_cn_cnm1");
      link.T_camera_body = Eigen::Isometry3d::Identity();
    }
    link.camera.T_vehicle_camera = link.T_camera_body->inverse();
  }
  return frame;
}

// 4Seasons repeats the chain as T_cam1_cam0, in addition to the cameras.
bool repeats_the_chain(const std::string& key) { return key.starts_with("T_cam"); }

std::string list(std::span<const double> numbers) {
  std::string text = "[";
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += (i == 0 ? "" : ", ") + decimal(numbers[i]);
  return text + "]";
}

std::string camera_text(const std::string& name, const MountedCamera& mounted) {
  const Camera& camera = mounted.camera;
  const std::string_view model = camera_model_name(camera.model);
  const std::size_t dash = model.find('-');
  const std::size_t intrinsics = first_focal_parameter(camera.model) + 4;
  const auto count = static_cast<std::size_t>(parameter_count(camera.model));
  const std::span<const double> parameters(camera.parameters);
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> T =
      mounted.T_vehicle_camera.inverse().matrix();
  std::string text = name + ":\n";
  text += "  camera_model: " + std::string(model.substr(0, dash)) + "\n";
  text += "  intrinsics: " + list(parameters.first(intrinsics)) + "\n";
  text += "  distortion_model: " + std::string(model.substr(dash + 1)) + "\n";
  text += "  distortion_coeffs: " + list(parameters.subspan(intrinsics, count - intrinsics)) + "\n";
  text += "  resolution: [" + std::to_string(camera.width) + ", " + std::to_string(camera.height) +
          "]\n  T_cam_imu:\n";
  for (int row = 0; row < 4; ++row) text += "    - " + list({T.data() + 4 * row, 4}) + "\n";
  text += "  timeshift_cam_imu: " + decimal(mounted.time_offset_s) + "\n";
  return text + "  cam_overlaps: []\n";
}

}  // namespace

Calibration read_kalibr_camchain(const std::filesystem::path& file) {
  YamlMap yaml = YamlMap::load(file);
  std::vector<Link> links;
  for (std::size_t i = 0;; ++i) {
    const std::string name = "cam" + std::to_string(i);
    if (!yaml.has(name)) break;
    if (auto camera = yaml.map(name)) links.push_back(read_link(*camera, name));
  }
  for (const auto& key : yaml.keys())
    if (repeats_the_chain(key)) yaml.ignore(key);
  if (links.empty()) yaml.report("cam0", "nothing", "the cameras of a chain: cam0, cam1, ...");
  Calibration result;
  // Faulty poses would only give faults that follow from them.
  if (yaml.problems().empty()) result.frame = resolve_poses(yaml, links);
  yaml.finish();
  for (Link& link : links) {
    result.rig.cameras.push_back(std::move(link.camera));
    result.states_time.push_back(link.states_time);
  }
  return result;
}

std::string kalibr_camchain_text(const Rig& rig) {
  std::string text;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    text += camera_text("cam" + std::to_string(i), rig.cameras[i]);
  return text;
}

}  // namespace roadbook
