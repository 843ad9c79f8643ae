#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "mapping/map.hpp"

namespace roadbook {

// Names of enumerations, and values of plain structs, as the map file stores them.

/// Bytes of one packed observation: int32 landmark, float32 u, v, sigma.
inline constexpr std::size_t kObservationBytes = 16;
inline constexpr std::size_t kWheelValues = 11;

[[nodiscard]] std::string_view scale_source_name(ScaleSource source);
[[nodiscard]] std::optional<ScaleSource> scale_source_from(std::string_view name);

/// Kalibr's names of the camera models, as in sensor.yaml.
[[nodiscard]] std::string_view camera_model_key(CameraModel model);
[[nodiscard]] std::optional<CameraModel> camera_model_from(std::string_view name);

/// In the order of the columns of `wheel_models`.
[[nodiscard]] std::array<double, kWheelValues> wheel_values(const WheelModel& model);
[[nodiscard]] WheelModel wheel_model_from(const std::array<double, kWheelValues>& values);

inline constexpr std::size_t kVehicleValues = 6;
using VehicleValues = std::array<std::optional<double>, kVehicleValues>;
/// In the order of the columns of `vehicles`.
[[nodiscard]] VehicleValues vehicle_values(const VehicleMeasures& vehicle);
[[nodiscard]] VehicleMeasures vehicle_from(const VehicleValues& values);

}  // namespace roadbook
