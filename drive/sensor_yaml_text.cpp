#include <numbers>
#include <span>
#include <string>

#include "base/error.hpp"
#include "drive/sensor_yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"

namespace roadbook {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    // A comment is one line; control characters have no place in it.
    out += c >= 0 && c < ' ' ? ' ' : c;
  }
  return out + "\"";
}

std::string list(std::span<const double> numbers) {
  std::string out = "[";
  for (std::size_t i = 0; i < numbers.size(); ++i) out += (i ? ", " : "") + decimal(numbers[i]);
  return out + "]";
}

std::string head(const std::string& type, const SensorInfo& info, const Eigen::Isometry3d& T) {
  std::string out = "sensor_type: " + type + "\n";
  if (!info.comment.empty()) out += "comment: " + quoted(info.comment) + "\n";
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> m = T.matrix();
  out += "T_BS:\n  cols: 4\n  rows: 4\n  data: " + list({m.data(), 16}) + "\n";
  if (info.rate_hz > 0.0) out += "rate_hz: " + decimal(info.rate_hz) + "\n";
  return out;
}

std::string line(const std::string& key, double value) {
  return key + ": " + decimal(value) + "\n";
}

struct ModelText {
  const char* projection;
  const char* distortion;
  std::size_t intrinsics;
  std::size_t coefficients;
};

ModelText model_text(CameraModel model) {
  switch (model) {
    case CameraModel::kPinholeRadtan:
      return {"pinhole", "radtan", 4, 4};
    case CameraModel::kKannalaBrandt:
      return {"pinhole", "equidistant", 4, 4};
    case CameraModel::kOmni:
      return {"omni", "radtan", 5, 4};
    case CameraModel::kDoubleSphere:
      return {"ds", "none", 6, 0};
  }
  ROADBOOK_ASSERT(false);
}

}  // namespace

std::string camera_yaml_text(const MountedCamera& camera, const SensorInfo& info) {
  const ModelText names = model_text(camera.camera.model);
  const std::span<const double> parameters(camera.camera.parameters);
  std::string out = head("camera", info, camera.T_vehicle_camera);
  out += "resolution: [" + std::to_string(camera.camera.width) + ", " +
         std::to_string(camera.camera.height) + "]\n";
  out += std::string("camera_model: ") + names.projection + "\n";
  out += "intrinsics: " + list(parameters.first(names.intrinsics)) + "\n";
  out += std::string("distortion_model: ") + names.distortion + "\n";
  out +=
      "distortion_coefficients: " + list(parameters.subspan(names.intrinsics, names.coefficients)) +
      "\n";
  if (camera.camera.max_angle_rad < Camera{}.max_angle_rad)
    out += line("max_angle", camera.camera.max_angle_rad);
  if (camera.time_offset_s != 0.0) out += line("time_offset", camera.time_offset_s);
  if (camera.rolling_shutter_s != 0.0) out += line("rolling_shutter", camera.rolling_shutter_s);
  return out;
}

std::string wheel_yaml_text(const WheelModel& wheels, const SensorInfo& info) {
  std::string out = head("wheels", info, Eigen::Isometry3d::Identity());
  out += line("wheel_radius_left", wheels.radius_left_m);
  out += line("wheel_radius_right", wheels.radius_right_m);
  out += line("track_width", wheels.track_width_m);
  out += line("wheelbase", wheels.wheelbase_m);
  out += line("steering_ratio", wheels.steering_ratio);
  if (wheels.ticks_per_turn > 0.0) out += line("ticks_per_turn", wheels.ticks_per_turn);
  if (wheels.time_offset_s != 0.0) out += line("time_offset", wheels.time_offset_s);
  out += line("sigma_distance_per_sqrt_m", wheels.sigma_distance_per_sqrt_m);
  out += line("sigma_heading_per_sqrt_m", wheels.sigma_heading_per_sqrt_m);
  out += line("sigma_lateral_per_sqrt_m", wheels.sigma_lateral_per_sqrt_m);
  out += line("sigma_angle", wheels.sigma_angle_rad);
  return out;
}

std::string range_yaml_text(const RangeModel& model, const SensorInfo& info) {
  std::string out = head("range", info, model.T_vehicle_sensor);
  if (model.time_offset_s != 0.0) out += line("time_offset", model.time_offset_s);
  out += "beam_azimuths: " + list(model.azimuth_rad) + "\n";
  out += line("max_range", model.max_m);
  out += line("sigma", model.sigma_m);
  return out;
}

std::string stream_yaml_text(const std::string& sensor_type, const StreamFile& stream) {
  std::string out = head(sensor_type, stream.info, stream.T_vehicle_sensor);
  if (stream.time_offset_s != 0.0) out += line("time_offset", stream.time_offset_s);
  if (!stream.camera.empty()) out += "camera: " + stream.camera + "\n";
  return out;
}

}  // namespace roadbook
