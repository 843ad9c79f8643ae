#include "drive/sensor_yaml.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

#include "base/se3.hpp"
#include "base/yaml.hpp"

namespace roadbook {
namespace {

// Matrices are printed with six decimals at worst; 1e-3 is far above that and far below any
// real mistake (degrees for radians, a transposed row, a scale).
constexpr double kRotationTolerance = 1e-3;
constexpr Range kPositive{1e-12, 1e12};
constexpr Range kNotNegative{0.0, 1e12};

std::optional<YamlMap> load(const std::filesystem::path& file, ProblemList& problems) {
  try {
    return YamlMap::load(file);
  } catch (const BadInput& bad) {
    problems.add_all(bad.problems());
    return std::nullopt;
  }
}

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

// Sixteen numbers, row by row: a list of rows, or EuRoC's mapping with rows, cols and data.
std::vector<double> read_matrix(YamlMap& yaml, const std::string& key) {
  std::vector<double> numbers;
  std::vector<std::vector<double>> rows;
  if (yaml.is_map(key)) {
    auto matrix = yaml.map(key);
    int n_rows = 4;
    int n_cols = 4;
    matrix->read("rows", n_rows, {4, 4});
    matrix->read("cols", n_cols, {4, 4});
    matrix->ignore("dt");
    if (matrix->has("data"))
      matrix->read_list("data", 16, numbers);
    else
      matrix->report("data", "nothing", "16 numbers");
  } else if (yaml.read(key, rows)) {
    for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
    const bool square =
        rows.size() == 4 &&
        std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.size() == 4; });
    if (!square) yaml.report(key, "a list of another shape", "4 rows of 4 numbers");
    if (!square) numbers.clear();
  }
  return numbers;
}

// T_BS: vehicle <- sensor, a proper rigid motion.
bool read_pose(YamlMap& yaml, const std::string& key, Eigen::Isometry3d& T_vehicle_sensor) {
  const auto numbers = read_matrix(yaml, key);
  if (numbers.size() != 16) return false;
  const Eigen::Matrix4d m =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kRotationTolerance)) {
    yaml.report(key, "a rotation off orthonormal by " + shown(off), "orthonormal axes");
    return false;
  }
  if (!(R.determinant() > 0.0)) {
    yaml.report(key, "a left-handed rotation (determinant " + shown(R.determinant()) + ")",
                "a right-handed one");
    return false;
  }
  if (!(m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).isZero(1e-9)) {
    yaml.report(key, "another last row", "0 0 0 1");
    return false;
  }
  // What is a rotation to the last bits already is kept bit for bit.
  T_vehicle_sensor.linear() = off < 1e-14 ? R : nearest_rotation(R);
  T_vehicle_sensor.translation() = m.topRightCorner<3, 1>();
  return true;
}

void read_info(YamlMap& yaml, SensorInfo& info) {
  yaml.read("comment", info.comment);
  yaml.read("rate_hz", info.rate_hz, kNotNegative);
}

void read_type(YamlMap& yaml, const std::string& want) {
  std::string type = want;
  if (yaml.require("sensor_type", type) && type != want) yaml.report("sensor_type", type, want);
}

struct ModelNames {
  CameraModel model;
  std::size_t intrinsics;
  std::size_t distortion;
};

// Kalibr's combinations (ConfigReader.py); EuRoC writes "radial-tangential" for "radtan".
std::optional<ModelNames> read_model(YamlMap& yaml) {
  std::string projection;
  std::string distortion = "none";
  if (!yaml.require("camera_model", projection)) return std::nullopt;
  const bool stated = yaml.require("distortion_model", distortion);
  if (distortion == "radial-tangential") distortion = "radtan";
  if (projection != "pinhole" && projection != "omni" && projection != "ds") {
    yaml.report("camera_model", projection, "pinhole, omni or ds");
    return std::nullopt;
  }
  if (!stated) return std::nullopt;
  if (distortion != "radtan" && distortion != "equidistant" && distortion != "none") {
    yaml.report("distortion_model", distortion, "radtan, equidistant or none");
    return std::nullopt;
  }
  const std::size_t coefficients = distortion == "none" ? 0 : 4;
  if (projection == "pinhole")
    return ModelNames{
        distortion == "equidistant" ? CameraModel::kKannalaBrandt : CameraModel::kPinholeRadtan, 4,
        coefficients};
  if (projection == "omni" && distortion != "equidistant")
    return ModelNames{CameraModel::kOmni, 5, coefficients};
  if (projection == "ds" && distortion == "none")
    return ModelNames{CameraModel::kDoubleSphere, 6, 0};
  yaml.report("distortion_model", distortion,
              projection == "ds" ? "none with ds" : "radtan or none with omni");
  return std::nullopt;
}

void read_intrinsics(YamlMap& yaml, Camera& camera) {
  const auto names = read_model(yaml);
  std::vector<double> intrinsics;
  std::vector<double> distortion;
  if (!names) {
    yaml.ignore("intrinsics");
    yaml.ignore("distortion_coefficients");
    return;
  }
  camera.model = names->model;
  if (yaml.require("intrinsics", intrinsics) && intrinsics.size() != names->intrinsics) {
    yaml.report("intrinsics", std::to_string(intrinsics.size()) + " numbers",
                std::to_string(names->intrinsics));
    intrinsics.clear();
  }
  if (names->distortion == 0)
    yaml.ignore("distortion_coefficients");
  else if (yaml.require("distortion_coefficients", distortion) &&
           distortion.size() != names->distortion)
    yaml.report("distortion_coefficients", std::to_string(distortion.size()) + " numbers",
                std::to_string(names->distortion));
  if (intrinsics.empty() || distortion.size() != names->distortion) return;
  const std::size_t focal = names->intrinsics - 4;
  if (!(intrinsics[focal] > 0.0) || !(intrinsics[focal + 1] > 0.0))
    yaml.report("intrinsics",
                "focal lengths " + shown(intrinsics[focal]) + ", " + shown(intrinsics[focal + 1]),
                "positive ones");
  std::copy(intrinsics.begin(), intrinsics.end(), camera.parameters.begin());
  std::copy(distortion.begin(), distortion.end(),
            camera.parameters.begin() + static_cast<std::ptrdiff_t>(intrinsics.size()));
}

void read_resolution(YamlMap& yaml, double max_megapixels, Camera& camera) {
  std::vector<double> size;
  if (!yaml.require("resolution", size)) return;
  const auto whole = [](double v) { return v >= 1.0 && v <= 1e6 && v == std::floor(v); };
  if (size.size() != 2 || !whole(size[0]) || !whole(size[1])) {
    yaml.report("resolution", std::to_string(size.size()) + " numbers",
                "[width, height], whole and positive");
    return;
  }
  if (size[0] * size[1] > max_megapixels * 1e6) {
    yaml.report("resolution", shown(size[0]) + "x" + shown(size[1]),
                "at most " + shown(max_megapixels) + " megapixels");
    return;
  }
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
}

// Gives the file's faults to the list; says whether there were none.
bool close(YamlMap& yaml, ProblemList& problems) {
  const auto found = yaml.finish_problems();
  problems.add_all(found);
  return found.empty();
}

}  // namespace

std::optional<CameraFile> read_camera_yaml(const std::filesystem::path& file,
                                           const std::string& name,
                                           double max_megapixels,
                                           ProblemList& problems) {
  auto yaml = load(file, problems);
  if (!yaml) return std::nullopt;
  CameraFile result;
  result.camera.name = name;
  read_type(*yaml, "camera");
  read_info(*yaml, result.info);
  if (!yaml->has("T_BS")) yaml->report("T_BS", "nothing", "this key");
  read_pose(*yaml, "T_BS", result.camera.T_vehicle_camera);
  read_resolution(*yaml, max_megapixels, result.camera.camera);
  read_intrinsics(*yaml, result.camera.camera);
  yaml->read("max_angle", result.camera.camera.max_angle_rad, {1e-3, std::numbers::pi});
  yaml->read("time_offset", result.camera.time_offset_s, {-10.0, 10.0});
  if (!close(*yaml, problems)) return std::nullopt;
  return result;
}

std::optional<WheelFile> read_wheel_yaml(const std::filesystem::path& file, ProblemList& problems) {
  auto yaml = load(file, problems);
  if (!yaml) return std::nullopt;
  WheelFile result;
  WheelModel& wheels = result.wheels;
  read_type(*yaml, "wheels");
  read_info(*yaml, result.info);
  // The wheels are the vehicle frame: a T_BS may stand there, as in every EuRoC file, as identity.
  Eigen::Isometry3d T_vehicle_wheels = Eigen::Isometry3d::Identity();
  if (yaml->has("T_BS") && read_pose(*yaml, "T_BS", T_vehicle_wheels) &&
      !T_vehicle_wheels.isApprox(Eigen::Isometry3d::Identity(), 1e-6))
    yaml->report("T_BS", "another pose", "the identity (the wheels define the vehicle frame)");
  yaml->require("wheel_radius_left", wheels.radius_left_m, kPositive);
  yaml->require("wheel_radius_right", wheels.radius_right_m, kPositive);
  yaml->require("track_width", wheels.track_width_m, kPositive);
  yaml->read("wheelbase", wheels.wheelbase_m, kPositive);
  yaml->read("steering_ratio", wheels.steering_ratio, kPositive);
  yaml->read("ticks_per_turn", wheels.ticks_per_turn, kNotNegative);
  yaml->read("time_offset", wheels.time_offset_s, {-10.0, 10.0});
  yaml->read("sigma_distance_per_sqrt_m", wheels.sigma_distance_per_sqrt_m, kNotNegative);
  yaml->read("sigma_heading_per_sqrt_m", wheels.sigma_heading_per_sqrt_m, kNotNegative);
  yaml->read("sigma_lateral_per_sqrt_m", wheels.sigma_lateral_per_sqrt_m, kNotNegative);
  yaml->read("sigma_angle", wheels.sigma_angle_rad, kNotNegative);
  if (!close(*yaml, problems)) return std::nullopt;
  return result;
}

std::optional<StreamFile> read_stream_yaml(const std::filesystem::path& file,
                                           ProblemList& problems) {
  auto yaml = load(file, problems);
  if (!yaml) return std::nullopt;
  StreamFile result;
  std::string type;
  yaml->read("sensor_type", type);
  read_info(*yaml, result.info);
  if (yaml->has("T_BS")) read_pose(*yaml, "T_BS", result.T_vehicle_sensor);
  yaml->read("time_offset", result.time_offset_s, {-10.0, 10.0});
  yaml->read("camera", result.camera);
  // Noise densities and a range sensor's beams concern their models, not the format.
  for (const auto& key : yaml->keys()) yaml->ignore(key);
  if (!close(*yaml, problems)) return std::nullopt;
  return result;
}

}  // namespace roadbook
