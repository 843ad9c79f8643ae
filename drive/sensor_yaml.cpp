#include "drive/sensor_yaml.hpp"

#include <cmath>
#include <numbers>

#include "base/yaml.hpp"
#include "drive/plausible.hpp"
#include "sensors/calibration/calibration_fields.hpp"

namespace roadbook {
namespace {

constexpr Range kPositive{1e-12, 1e12};
constexpr Range kNotNegative{0.0, 1e12};
constexpr Range kNoise{0.0, 100.0};  // of a metre driven, or of an angle
constexpr Range kRate_hz{0.0, 1e6};

std::optional<YamlMap> load(const std::filesystem::path& file, ProblemList& problems) {
  try {
    return YamlMap::load(file);
  } catch (const BadInput& bad) {
    problems.add_all(bad.problems());
    return std::nullopt;
  }
}

void read_info(YamlMap& yaml, SensorInfo& info) {
  yaml.read("comment", info.comment);
  yaml.read("rate_hz", info.rate_hz, kRate_hz);
}

void read_type(YamlMap& yaml, const std::string& want) {
  std::string type = want;
  if (yaml.require("sensor_type", type) && type != want) yaml.report("sensor_type", type, want);
}

// Gives the file's faults to the list; says whether there were none.
bool close_yaml(YamlMap& yaml, ProblemList& problems) {
  const auto found = yaml.finish_problems();
  problems.add_all(found);
  return found.empty();
}

}  // namespace

std::int64_t offset_ns(double time_offset_s) {
  return static_cast<std::int64_t>(std::llround(1e9 * time_offset_s));
}

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
  read_rigid_motion(*yaml, "T_BS", result.camera.T_vehicle_camera);
  read_resolution(*yaml, max_megapixels, result.camera.camera);
  read_kalibr_lens(*yaml, "distortion_coefficients", result.camera.camera);
  yaml->read("max_angle", result.camera.camera.max_angle_rad, {1e-3, std::numbers::pi});
  yaml->read("time_offset", result.camera.time_offset_s, {-10.0, 10.0});
  yaml->read("rolling_shutter", result.camera.rolling_shutter_s, {-0.2, 0.2});
  if (!close_yaml(*yaml, problems)) return std::nullopt;
  check_camera_sizes(file.string(), result.camera, problems);
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
  if (yaml->has("T_BS") && read_rigid_motion(*yaml, "T_BS", T_vehicle_wheels) &&
      !T_vehicle_wheels.isApprox(Eigen::Isometry3d::Identity(), 1e-6))
    yaml->report("T_BS", "another pose", "the identity (the wheels define the vehicle frame)");
  yaml->require("wheel_radius_left", wheels.radius_left_m, kPositive);
  yaml->require("wheel_radius_right", wheels.radius_right_m, kPositive);
  yaml->require("track_width", wheels.track_width_m, kPositive);
  yaml->read("wheelbase", wheels.wheelbase_m, kPositive);
  yaml->read("steering_ratio", wheels.steering_ratio, kPositive);
  yaml->read("ticks_per_turn", wheels.ticks_per_turn, kNotNegative);
  yaml->read("wraps_at", wheels.wraps_at, kPositive);
  yaml->read("time_offset", wheels.time_offset_s, {-10.0, 10.0});
  yaml->read("sigma_distance_per_sqrt_m", wheels.sigma_distance_per_sqrt_m, kNoise);
  yaml->read("sigma_heading_per_sqrt_m", wheels.sigma_heading_per_sqrt_m, kNoise);
  yaml->read("sigma_lateral_per_sqrt_m", wheels.sigma_lateral_per_sqrt_m, kNoise);
  yaml->read("sigma_angle", wheels.sigma_angle_rad, kNoise);
  if (!close_yaml(*yaml, problems)) return std::nullopt;
  const std::size_t errors = problems.error_count();
  check_wheel_sizes(file.string(), wheels, problems);
  if (problems.error_count() > errors) return std::nullopt;
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
  if (yaml->has("T_BS")) read_rigid_motion(*yaml, "T_BS", result.T_vehicle_sensor);
  yaml->read("time_offset", result.time_offset_s, {-10.0, 10.0});
  yaml->read("camera", result.camera);
  if (yaml->has("beam_azimuths")) {
    RangeModel& range = result.range.emplace();
    yaml->read("beam_azimuths", range.azimuth_rad);
    yaml->read("max_range", range.max_m, {1e-3, 1e5});
    yaml->read("sigma", range.sigma_m, {1e-12, 1e3});
    range.T_vehicle_sensor = result.T_vehicle_sensor;
    range.time_offset_s = result.time_offset_s;
  }
  // Noise densities concern their models, not the format.
  for (const auto& key : yaml->keys()) yaml->ignore(key);
  if (!close_yaml(*yaml, problems)) return std::nullopt;
  return result;
}

}  // namespace roadbook
