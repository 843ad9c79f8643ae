#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "drive/drive.hpp"
#include "sensors/vehicle.hpp"

namespace roadbook {

/// The vehicle that carries the cameras of a drive, and where its cameras see it.
struct OwnCar {
  VehicleSource source = VehicleSource::kNone;
  VehicleMeasures vehicle;  ///< empty unless `source` is a file or an option
  /// Masks of the half-size images, one a camera: 0 where the own vehicle is seen, 255 elsewhere;
  /// an empty Mat where it is not seen.
  std::vector<cv::Mat> masks;

  /// Share of the camera's image that the mask covers, 0 to 1.
  [[nodiscard]] double masked_share(std::size_t camera) const;
};

/// Finds the own vehicle of `drive`: from `given` measures, else the drive's vehicle.yaml, else the
/// images.
///
/// A camera's mask is `camN/mask.png` if the drive has one (any size, 0: own vehicle). Otherwise it
/// is the union of parts that never move in images spread over the drive (`find_still_parts`) and
/// of pixels that the body's box hides (`is_hidden_by_body`), if the vehicle is described. Measures
/// without a body are ignored. Deterministic. Throws BadInput where a `mask.png` cannot be read or
/// hides the whole image.
[[nodiscard]] OwnCar find_own_car(const Drive& drive,
                                  const std::optional<VehicleMeasures>& given,
                                  int num_threads);

/// Returns an 8-bit mask of the camera's size: 255 where the ray of the pixel meets the body, 0
/// elsewhere. All 0 if the camera is inside the outline of the body. `body`: vehicle frame [m].
[[nodiscard]] cv::Mat pixels_of_body(const Eigen::AlignedBox3d& body,
                                     const Camera& camera,
                                     const Eigen::Isometry3d& T_vehicle_camera);

}  // namespace roadbook
