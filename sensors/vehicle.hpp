#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string_view>

#include "sensors/rig.hpp"

namespace roadbook {

// The measures of the vehicle that carries the sensors, and the space that its body takes.
//
// Vehicle frame: on the ground under the middle of the rear axle, x forward, y left, z up.

/// What `vehicle.yaml` says (docs/reference/drive_format.md). An empty measure is not known.
struct VehicleMeasures {
  std::optional<double> length_m;         ///< bumper to bumper
  std::optional<double> width_m;          ///< of the body, without mirrors
  std::optional<double> height_m;         ///< of the roof above the ground
  std::optional<double> rear_overhang_m;  ///< from the rear axle back to the rear bumper
  std::optional<double> wheelbase_m;
  std::optional<double> track_width_m;  ///< of the rear axle, between the middles of the tyres

  bool operator==(const VehicleMeasures&) const = default;

  [[nodiscard]] bool is_empty() const { return *this == VehicleMeasures{}; }
  /// From the front axle forward to the front bumper; empty where a measure for it is not known.
  [[nodiscard]] std::optional<double> front_overhang_m() const;
  /// The width, or the track width and 0.25 m: what bodies of cars add to it.
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

/// The body of a vehicle, or, where its measures give none, what its cameras enclose: the rectangle
/// between them, seen from above, as high as the lowest. It lies within the body of a car that
/// carries cameras round it, and has no area for a single camera. Empty without cameras.
[[nodiscard]] Eigen::AlignedBox3d body_or_outline(const VehicleMeasures& vehicle, const Rig& rig);

/// Whether a place lies within the body's outline, seen from above. Places on the border are
/// outside: a camera on the surface of the body looks away from it.
[[nodiscard]] bool is_above_body(const Eigen::AlignedBox3d& body, const Eigen::Vector3d& p_vehicle);

/// Whether the body hides `p_vehicle` from a camera at `centre_vehicle`.
///
/// A place on the ground within the body's outline is always hidden. A camera within the outline
/// (on the roof, behind the windscreen) sees past the body: a box says nothing of where its bonnet
/// ends, so what such a camera sees of the body is measured in its images.
[[nodiscard]] bool is_hidden_by_body(const Eigen::AlignedBox3d& body,
                                     const Eigen::Vector3d& centre_vehicle,
                                     const Eigen::Vector3d& p_vehicle);

}  // namespace roadbook
