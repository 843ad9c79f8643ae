#include "mapping/store/map_file_names.hpp"

#include <utility>

#include "base/error.hpp"

namespace roadbook {
namespace {

template <typename T, std::size_t N>
using Names = std::array<std::pair<T, std::string_view>, N>;

constexpr Names<ScaleSource, 3> kScaleSources{{{ScaleSource::kWheels, "wheels"},
                                               {ScaleSource::kCameraHeight, "camera_height"},
                                               {ScaleSource::kFree, "free"}}};

// Spelled here, too: a file's words must not change with another module's function.
constexpr Names<CameraModel, 4> kCameraModels{{{CameraModel::kPinholeRadtan, "pinhole-radtan"},
                                               {CameraModel::kKannalaBrandt, "pinhole-equidistant"},
                                               {CameraModel::kOmni, "omni-radtan"},
                                               {CameraModel::kDoubleSphere, "ds-none"}}};

template <typename T, std::size_t N>
std::string_view name_of(const Names<T, N>& names, T value) {
  for (const auto& [known, name] : names)
    if (known == value) return name;
  assertion_failed("a named value", __FILE__, __LINE__);
}

template <typename T, std::size_t N>
std::optional<T> value_named(const Names<T, N>& names, std::string_view text) {
  for (const auto& [known, name] : names)
    if (name == text) return known;
  return std::nullopt;
}

}  // namespace

std::string_view scale_source_name(ScaleSource source) { return name_of(kScaleSources, source); }

std::optional<ScaleSource> scale_source_from(std::string_view name) {
  return value_named(kScaleSources, name);
}

std::string_view camera_model_key(CameraModel model) { return name_of(kCameraModels, model); }

std::optional<CameraModel> camera_model_from(std::string_view name) {
  return value_named(kCameraModels, name);
}

std::array<double, kWheelValues> wheel_values(const WheelModel& m) {
  return {m.radius_left_m,
          m.radius_right_m,
          m.track_width_m,
          m.wheelbase_m,
          m.steering_ratio,
          m.ticks_per_turn,
          m.time_offset_s,
          m.sigma_distance_per_sqrt_m,
          m.sigma_heading_per_sqrt_m,
          m.sigma_lateral_per_sqrt_m,
          m.sigma_angle_rad};
}

WheelModel wheel_model_from(const std::array<double, kWheelValues>& v) {
  WheelModel m;
  m.radius_left_m = v[0];
  m.radius_right_m = v[1];
  m.track_width_m = v[2];
  m.wheelbase_m = v[3];
  m.steering_ratio = v[4];
  m.ticks_per_turn = v[5];
  m.time_offset_s = v[6];
  m.sigma_distance_per_sqrt_m = v[7];
  m.sigma_heading_per_sqrt_m = v[8];
  m.sigma_lateral_per_sqrt_m = v[9];
  m.sigma_angle_rad = v[10];
  return m;
}

VehicleValues vehicle_values(const VehicleMeasures& v) {
  return {v.length_m, v.width_m, v.height_m, v.rear_overhang_m, v.wheelbase_m, v.track_width_m};
}

VehicleMeasures vehicle_from(const VehicleValues& values) {
  return {values[0], values[1], values[2], values[3], values[4], values[5]};
}

}  // namespace roadbook
