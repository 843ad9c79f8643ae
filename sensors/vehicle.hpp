#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "sensors/rig.hpp"

namespace roadbook {

// The measures of the vehicle that carries the sensors, and the space that its body fills.
//
// Vehicle frame: on the ground under the middle of the rear axle, x forward, y left, z up.

/// The content of `vehicle.yaml` (docs/reference/drive_format.md). An empty measure is unknown.
struct VehicleMeasures {
  std::optional<double> length_m;         ///< bumper to bumper
  std::optional<double> width_m;          ///< of the body, without mirrors
  std::optional<double> height_m;         ///< of the roof above the ground
  std::optional<double> rear_overhang_m;  ///< from the rear axle back to the rear bumper
  std::optional<double> wheelbase_m;
  std::optional<double> track_width_m;  ///< of the rear axle, between the middles of the tyres

  bool operator==(const VehicleMeasures&) const = default;

  [[nodiscard]] bool is_empty() const { return *this == VehicleMeasures{}; }
  /// From the front axle forward to the front bumper; empty if a measure for it is unknown.
  [[nodiscard]] std::optional<double> front_overhang_m() const;
  /// The width, or else the track width plus 0.25 m, which bodies of cars usually add.
  [[nodiscard]] std::optional<double> width_or_estimate_m() const;
  /// The box that the body fills. A measure that is not known is estimated:
  ///  - width: `width_or_estimate_m`;
  ///  - length: wheelbase and twice the rear overhang (both ends alike);
  ///  - rear overhang: half of what the length leaves beside the wheelbase, or a fifth of the
  ///    length where the wheelbase is not known either (cars: 0.17 to 0.24);
  ///  - height: without end, so that no line of sight passes over the body.
  /// Empty where length or width cannot be estimated.
  [[nodiscard]] std::optional<Eigen::AlignedBox3d> body() const;
};

/// Where the knowledge of the own vehicle comes from.
enum class VehicleSource {
  kNone,      ///< neither described nor seen in the images
  kMeasured,  ///< not described; seen in the images as what never moves
  kFile,      ///< vehicle.yaml of the drive
  kOption,    ///< --vehicle
};

/// "none", "measured", "file", "option".
[[nodiscard]] std::string_view vehicle_source_name(VehicleSource source);
/// The inverse; empty for another name.
[[nodiscard]] std::optional<VehicleSource> vehicle_source_from(std::string_view name);

/// Returns the body of a vehicle. If its measures give none, returns the rectangle between its
/// cameras, seen from above, as high as the lowest camera. This rectangle lies within the body of a
/// car with cameras on all sides, and has no area for a single camera. Empty without cameras.
[[nodiscard]] Eigen::AlignedBox3d body_or_outline(const VehicleMeasures& vehicle, const Rig& rig);

/// Whether a point lies within the body's outline, seen from above. Points on the border are
/// outside, because a camera on the surface of the body looks away from it.
[[nodiscard]] bool is_above_body(const Eigen::AlignedBox3d& body, const Eigen::Vector3d& p_vehicle);

/// Whether the body hides `p_vehicle` from a camera at `centre_vehicle` (vehicle frame [m]).
///
/// A point on the ground within the body's outline is always hidden. A camera within the outline
/// (on the roof, behind the windscreen) sees past the body, because a box does not tell where the
/// bonnet ends. `find_still_parts` finds the body in the images of such a camera.
[[nodiscard]] bool is_hidden_by_body(const Eigen::AlignedBox3d& body,
                                     const Eigen::Vector3d& centre_vehicle,
                                     const Eigen::Vector3d& p_vehicle);

}  // namespace roadbook
