#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "diagnosis/views/hinge.hpp"
#include "diagnosis/views/view_data.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

// Elementary columns (derivatives) of the problem of views. Each row has entries in one strip of
// columns only: a view in the strip of its camera, a motion in that of the wheels, a ground height
// in that of the ground. An effect of the whole rig is the sum of the columns of its cameras. Order
// of the columns:
//
//   cam0: effects, turns of the rig, radial terms, tangential terms | cam1: ... | wheels,
//   variations | hinges | ground

/// The first two change when a camera sees, the others change the camera.
inline constexpr std::array<std::string_view, 15> kCameraColumns{
    "latency",  "rolling_shutter", "focal",       "aspect",   "centre", "centre_x",
    "centre_y", "distortion",      "distortion2", "rotation", "pitch",  "roll",
    "position", "lateral",         "height"};
inline constexpr std::size_t kLatencyColumn = 0;
inline constexpr std::size_t kShutterColumn = 1;
inline constexpr std::size_t kPitchColumn = 10;
inline constexpr std::size_t kLateralColumn = 13;
inline constexpr std::size_t kHeightColumn = 14;
static_assert(kCameraColumns[kLateralColumn] == "lateral");
static_assert(kCameraColumns[kPitchColumn] == "pitch");
static_assert(kCameraColumns[kHeightColumn] == "height");
/// Turns of the rig as one body. Each is an effect of all cameras together only.
inline constexpr std::array<std::string_view, 3> kRigColumns{"rotation", "pitch", "roll"};
/// The columns that change a camera follow each other: its own effects, then turns of the rig.
inline constexpr std::size_t kFirstGeometryColumn = 2;
inline constexpr std::size_t kFirstTermColumn = kCameraColumns.size() + kRigColumns.size();
inline constexpr std::size_t kGeometryColumns = kFirstTermColumn - kFirstGeometryColumn;
inline constexpr std::array<std::string_view, 9> kWheelColumns{
    "radius",  "left_radius",       "right_radius", "radius_difference", "track_width",
    "latency", "slip_acceleration", "radius_speed", "eccentricity"};
/// A wheel column multiplied by a covariate. It is never reported as an effect; it tests whether
/// the size of an accepted effect depends on the covariate, which reveals a wrong effect.
struct WheelVariation {
  std::string_view column;
  std::string_view covariate;
};
inline constexpr std::array<WheelVariation, 13> kWheelVariations{{{"radius", "speed"},
                                                                  {"radius", "speed squared"},
                                                                  {"radius", "acceleration"},
                                                                  {"radius", "turn rate"},
                                                                  {"radius", "time"},
                                                                  {"track_width", "speed"},
                                                                  {"track_width", "acceleration"},
                                                                  {"track_width", "turn rate"},
                                                                  {"track_width", "time"},
                                                                  {"latency", "speed"},
                                                                  {"latency", "acceleration"},
                                                                  {"latency", "turn rate"},
                                                                  {"latency", "time"}}};
/// The wheels roll on the same sloped plane, so `slope` also changes the motions.
inline constexpr std::array<std::string_view, 2> kGroundColumns{"height", "slope"};

/// Basis functions of the generic effects of a view: what a pixel shift may depend on. The first is
/// the constant.
struct ViewTerms {
  std::string_view covariate;
  std::size_t first = 0;
  std::size_t count = 0;
};
inline constexpr std::array<ViewTerms, 8> kViewTerms{{{"constant", 0, 1},
                                                      {"image radius", 1, 3},
                                                      {"azimuth", 4, 4},
                                                      {"row", 8, 2},
                                                      {"speed", 10, 1},
                                                      {"turn rate", 11, 1},
                                                      {"time", 12, 2},
                                                      {"place", 14, 5}}};
inline constexpr std::size_t kViewTermCount = 19;
inline constexpr std::array<std::string_view, 2> kViewHooks{"radial", "tangential"};

struct ViewBasis {
  std::size_t cameras = 0;
  std::size_t hinges = 0;  ///< number of hinges; their lines are in ViewPoint::hinges

  [[nodiscard]] std::size_t per_camera() const { return kFirstTermColumn + 2 * kViewTermCount; }
  [[nodiscard]] std::size_t camera(std::size_t c) const { return c * per_camera(); }
  [[nodiscard]] std::size_t term(std::size_t c, std::size_t hook, std::size_t t) const {
    return camera(c) + kFirstTermColumn + hook * kViewTermCount + t;
  }
  [[nodiscard]] std::size_t wheels() const { return camera(cameras); }
  [[nodiscard]] std::size_t variations() const { return wheels() + kWheelColumns.size(); }
  /// Index of the first of the three columns of hinge h.
  [[nodiscard]] std::size_t hinge(std::size_t h = 0) const {
    return variations() + kWheelVariations.size() + h * kHingeColumns;
  }
  [[nodiscard]] std::size_t ground() const { return hinge(hinges); }
  [[nodiscard]] std::size_t size() const { return ground() + kGroundColumns.size(); }
};

/// Scales of the covariates, chosen so that each basis function is about 1.
struct ViewFrame {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< middle of the driven area [m], map frame
  double reach_m = 1.0;
  double end_s = 1.0;
};
[[nodiscard]] ViewFrame view_frame(const ViewData& data);

/// Values of all basis functions for a predicted pixel of `camera`. `moment`: the car's motion at
/// the keyframe. `place`: position of the car in the map [m].
[[nodiscard]] std::array<double, kViewTermCount> view_terms(const ViewFrame& frame,
                                                            const Camera& camera,
                                                            const Eigen::Vector2d& pixel,
                                                            const ViewMoment& moment,
                                                            const Eigen::Vector2d& place);
/// Mean value of a wheel covariate between two keyframes, scaled to about 1 in a car park. `end_s`:
/// duration of the drive [s].
[[nodiscard]] double covariate_value(std::string_view covariate,
                                     const ViewMoment& from,
                                     const ViewMoment& to,
                                     double end_s);
/// Unit vector from the middle of the camera's image to the pixel. Its left normal is the
/// tangential direction.
[[nodiscard]] Eigen::Vector2d radial_direction(const Camera& camera, const Eigen::Vector2d& pixel);

}  // namespace roadbook
