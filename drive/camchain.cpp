#include "drive/camchain.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "sensors/calibration/calibration_io.hpp"

namespace roadbook {
namespace {

constexpr double kTolerance = 1e-6;

std::string shown(double value) {
  std::ostringstream text;
  text.precision(9);
  text << value;
  return text.str();
}

const MountedCamera* find(const Rig& rig, const std::string& name) {
  const auto found = std::find_if(rig.cameras.begin(), rig.cameras.end(),
                                  [&](const auto& camera) { return camera.name == name; });
  return found == rig.cameras.end() ? nullptr : &*found;
}

class Comparison {
 public:
  Comparison(std::string file, ProblemList& problems)
      : file_(std::move(file)), problems_(problems) {}

  void lens(const MountedCamera& chain, const MountedCamera& rig) {
    const Camera& a = chain.camera;
    const Camera& b = rig.camera;
    if (a.model != b.model)
      return differ(chain, "camera_model", std::string(camera_model_name(a.model)),
                    std::string(camera_model_name(b.model)));
    if (a.width != b.width || a.height != b.height)
      differ(chain, "resolution", std::to_string(a.width) + "x" + std::to_string(a.height),
             std::to_string(b.width) + "x" + std::to_string(b.height));
    const int distortion = a.model == CameraModel::kOmni ? 5 : 4;
    for (int i = 0; i < parameter_count(a.model); ++i) {
      const double p = a.parameters[static_cast<std::size_t>(i)];
      const double q = b.parameters[static_cast<std::size_t>(i)];
      if (std::abs(p - q) <= kTolerance * std::max(std::abs(p), std::abs(q))) continue;
      const bool intrinsic = i < distortion || a.model == CameraModel::kDoubleSphere;
      return differ(chain, intrinsic ? "intrinsics" : "distortion_coeffs", shown(p), shown(q));
    }
  }

  void pose(const MountedCamera& chain, const Eigen::Isometry3d& T_body_camera) {
    const Eigen::Matrix4d off =
        chain.T_vehicle_camera.inverse() * T_body_camera.matrix() - Eigen::Matrix4d::Identity();
    const double size = off.cwiseAbs().maxCoeff();
    if (!(size <= kTolerance))
      differ(chain, "T_cam_imu", "a pose off by " + shown(size), "the inverse of T_BS");
  }

  void time(const MountedCamera& chain, const MountedCamera& rig) {
    if (!(std::abs(chain.time_offset_s - rig.time_offset_s) <= kTolerance))
      differ(chain, "timeshift_cam_imu", shown(chain.time_offset_s), shown(rig.time_offset_s));
  }

 private:
  void differ(const MountedCamera& camera,
              const std::string& field,
              const std::string& got,
              const std::string& want) {
    problems_.error(file_, 0, camera.name + "." + field, got, want + " as in sensor.yaml");
  }

  std::string file_;
  ProblemList& problems_;
};

}  // namespace

bool is_camchain_name(std::string_view name) {
  if (!name.ends_with(".yaml")) return false;
  name.remove_suffix(5);
  const auto at = name.find("camchain");
  if (at == std::string_view::npos) return false;
  const std::string_view rest = name.substr(at + std::string_view("camchain").size());
  return (at == 0 || name[at - 1] == '-') && (rest.empty() || rest.front() == '-');
}

std::vector<std::filesystem::path> camchain_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (is_camchain_name(it->path().filename().string())) files.push_back(it->path());
  std::sort(files.begin(), files.end());
  return files;
}

namespace {

// What a file states of the cameras of the rig.
struct Statement {
  bool lenses = false;
  bool poses_in_vehicle = false;
  bool times = false;

  [[nodiscard]] bool covers(const Statement& other) const {
    return lenses && (poses_in_vehicle || !other.poses_in_vehicle) && (times || !other.times);
  }
};

Statement compare_camchain(const Calibration& chain,
                           const std::filesystem::path& file,
                           const Rig& rig,
                           ProblemList& problems) {
  Statement stated;
  Comparison comparison(file.string(), problems);
  // If the first camera is the chain's reference, the compared poses are relative to it too.
  const MountedCamera* const first = find(rig, chain.rig.cameras.front().name);
  const bool among_cameras = chain.frame != CalibrationFrame::kBody;
  for (std::size_t i = 0; i < chain.rig.cameras.size(); ++i) {
    const MountedCamera& camera = chain.rig.cameras[i];
    const MountedCamera* const mounted = find(rig, camera.name);
    if (mounted == nullptr) {
      problems.warning(file.string(), 0, camera.name, "a camera that the drive lacks",
                       "the cameras of the drive");
      continue;
    }
    stated.lenses = true;
    stated.poses_in_vehicle = stated.poses_in_vehicle || !among_cameras;
    stated.times = stated.times || chain.states_time[i];
    comparison.lens(camera, *mounted);
    // Kalibr writes no time offset where it calibrated cameras alone.
    if (chain.states_time[i]) comparison.time(camera, *mounted);
    if (!among_cameras)
      comparison.pose(camera, mounted->T_vehicle_camera);
    else if (first != nullptr)
      comparison.pose(camera, first->T_vehicle_camera.inverse() * mounted->T_vehicle_camera);
  }
  for (const auto& camera : rig.cameras)
    if (find(chain.rig, camera.name) == nullptr)
      problems.warning(file.string(), 0, camera.name, "nothing", "every camera of the drive");
  return stated;
}

}  // namespace

void check_camchains(const std::vector<std::filesystem::path>& files,
                     const Rig& rig,
                     ProblemList& problems) {
  std::vector<ProblemList> found(files.size());
  std::vector<Statement> stated(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) try {
      stated[i] = compare_camchain(read_kalibr_camchain(files[i]), files[i], rig, found[i]);
    } catch (const BadInput& bad) {
      problems.add_all(bad.problems());
    }
  for (std::size_t i = 0; i < files.size(); ++i) {
    bool another_agrees = false;
    for (std::size_t k = 0; k < files.size(); ++k)
      another_agrees = another_agrees || (!found[k].has_errors() && stated[k].covers(stated[i]));
    for (Problem problem : found[i].problems()) {
      if (another_agrees) problem.severity = Severity::kWarning;
      problems.add(std::move(problem));
    }
  }
}

}  // namespace roadbook
