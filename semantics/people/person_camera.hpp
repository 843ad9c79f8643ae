#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "sensors/rig.hpp"

namespace roadbook {

// People in raw fisheye images (document 004, VI-B). A person stands along the image's local
// vertical, which turns with the place in a fisheye image; upright windows are therefore cut along
// it, through the camera model: a window's columns are azimuths about the vehicle's z axis through
// the camera's centre, its rows slopes (height over horizontal distance). No other rectification.

/// An upright window around somebody, seen from one camera.
struct PersonBox {
  int camera = 0;           ///< index in the rig
  double azimuth = 0.0;     ///< of the middle, vehicle frame, 0 ahead, to the left positive [rad]
  double foot_slope = 0.0;  ///< of the feet: height over horizontal distance, below the camera < 0
  double size = 0.0;        ///< height over horizontal distance, feet to crown

  static constexpr double kBreadth = 0.41;  ///< width of a person's box over its height
};

/// Area common to both over the area that either covers, in azimuth and slope; 0 for boxes of
/// different cameras.
[[nodiscard]] double intersection_over_union(const PersonBox& a, const PersonBox& b);

/// Box of somebody of `height_m` whose feet are at `p_vehicle`, seen from `mounted`.
[[nodiscard]] PersonBox box_of_person(int camera,
                                      const MountedCamera& mounted,
                                      const Eigen::Vector3d& foot_vehicle,
                                      double height_m);

/// A camera image and its halves, so that near people are not undersampled.
using ImagePyramid = std::vector<cv::Mat>;
[[nodiscard]] ImagePyramid image_pyramid(const cv::Mat& grey);

/// A part of the cylinder of azimuths and slopes as a picture: column u is azimuth
/// `left - u / scale`, row v slope `top - v / scale`.
struct CylinderPatch {
  double left = 0.0;
  double top = 0.0;
  double scale = 100.0;  ///< [px per rad of azimuth, per unit of slope]
  cv::Size size;
};

/// One camera as the search for people uses it: where each place of the cylinder lies in its image.
/// A plain value; thread-safe.
class PersonCamera {
 public:
  /// `mask`: 8 bit, any size, 0 where the own car is seen; empty: none.
  PersonCamera(const MountedCamera& mounted, const cv::Mat& mask);

  [[nodiscard]] const MountedCamera& mounted() const { return mounted_; }
  [[nodiscard]] double height_m() const { return mounted_.T_vehicle_camera.translation().z(); }
  /// Azimuth of the optical axis [rad].
  [[nodiscard]] double heading() const { return heading_; }

  /// Pixel coordinates of every pixel of the patch in octave `octave_of(scale)` of the pyramid
  /// (CV_32FC2; -1e4 where the camera does not see).
  [[nodiscard]] cv::Mat pixel_map(const CylinderPatch& patch) const;
  [[nodiscard]] int octave_of(double scale) const;
  /// 8 bit, 255 where the camera sees past the own car.
  [[nodiscard]] cv::Mat seen(const CylinderPatch& patch) const;
  [[nodiscard]] cv::Mat cut(const ImagePyramid& image, const CylinderPatch& patch) const;
  /// Image pixel of a place of the cylinder, empty where it is not seen; the mask is looked at.
  [[nodiscard]] bool sees(double azimuth, double slope) const;

 private:
  [[nodiscard]] Eigen::Vector2d pixel(double azimuth, double slope) const;

  MountedCamera mounted_;
  cv::Mat mask_;  ///< of the image's size, may be empty
  double heading_ = 0.0;
};

}  // namespace roadbook
