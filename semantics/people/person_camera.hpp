#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/rig.hpp"

namespace roadbook {

// Windows of people in raw fisheye images. A person stands along the local vertical of the image,
// whose direction changes across a fisheye image. Windows are therefore cut through the camera
// model on a cylinder about the vertical axis (vehicle z) through the camera centre: columns are
// azimuths, rows are slopes (height over horizontal distance). The image is not rectified in any
// other way. Source: [metric-semantic maps, section VI-B].

/// Bounding box of a person in azimuth and slope, seen from one camera.
struct PersonBox {
  int camera = 0;           ///< index in the rig
  double azimuth = 0.0;     ///< of the middle, vehicle frame, 0 ahead, positive to the left [rad]
  double foot_slope = 0.0;  ///< of the feet: height over horizontal distance; below the camera < 0
  double size = 0.0;        ///< slope of the crown minus slope of the feet

  static constexpr double kBreadth = 0.41;  ///< width of a person's box, share of its height
};

/// Intersection over union of two boxes in azimuth and slope; 0 for boxes of different cameras.
[[nodiscard]] double intersection_over_union(const PersonBox& a, const PersonBox& b);

/// Box of a person of `height_m` with feet at `foot_vehicle` (vehicle frame), seen from `mounted`.
[[nodiscard]] PersonBox box_of_person(int camera,
                                      const MountedCamera& mounted,
                                      const Eigen::Vector3d& foot_vehicle,
                                      double height_m);

/// A camera image and repeatedly halved copies, so that windows of near people are not aliased.
using ImagePyramid = std::vector<cv::Mat>;
[[nodiscard]] ImagePyramid image_pyramid(const cv::Mat& grey);

/// A rectangle of the cylinder, sampled as an image: column u is azimuth `left - u / scale`, row v
/// is slope `top - v / scale`.
struct CylinderPatch {
  double left = 0.0;
  double top = 0.0;
  double scale = 100.0;  ///< [px per rad of azimuth, per unit of slope]
  cv::Size size;
};

/// A camera for the search for people: maps azimuth and slope to pixels. A plain value; const
/// functions are thread-safe.
class PersonCamera {
 public:
  /// `mask`: 8 bit, any size, 0 where the own vehicle is visible; empty: no mask.
  PersonCamera(const MountedCamera& mounted, const cv::Mat& mask);

  [[nodiscard]] const MountedCamera& mounted() const { return mounted_; }
  [[nodiscard]] double height_m() const { return mounted_.T_vehicle_camera.translation().z(); }
  /// Azimuth of the optical axis [rad].
  [[nodiscard]] double heading() const { return heading_; }

  /// Pixel coordinates for every pixel of the patch, in octave `octave_of(scale)` of the pyramid
  /// (CV_32FC2; -1e4 outside the camera's view).
  [[nodiscard]] cv::Mat pixel_map(const CylinderPatch& patch) const;
  [[nodiscard]] int octave_of(double scale) const;
  /// 8 bit, 255 where the camera sees the scene and not the own vehicle.
  [[nodiscard]] cv::Mat seen(const CylinderPatch& patch) const;
  [[nodiscard]] cv::Mat cut(const ImagePyramid& image, const CylinderPatch& patch) const;
  /// True if the direction lies in the image and not on the own vehicle.
  [[nodiscard]] bool sees(double azimuth, double slope) const;

 private:
  [[nodiscard]] Eigen::Vector2d pixel(double azimuth, double slope) const;

  MountedCamera mounted_;
  cv::Mat mask_;  ///< image size; may be empty
  double heading_ = 0.0;
};

}  // namespace roadbook
