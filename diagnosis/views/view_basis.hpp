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

// The elementary columns of the problem of views. A row has entries in one strip of them only:
// views in the strip of their camera, motions of the wheels and heights of the ground in theirs.
// Effects of the whole rig are sums of those of its cameras.
//
//   cam0: effects, radial terms, tangential terms | cam1: ... | wheels, variations | hinges |
//   ground

inline constexpr std::array<std::string_view, 7> kCameraColumns{
    "focal", "centre", "distortion", "rotation", "position", "latency", "rolling_shutter"};
inline constexpr std::array<std::string_view, 9> kWheelColumns{
    "radius",  "left_radius",       "right_radius", "radius_difference", "track_width",
    "latency", "slip_acceleration", "radius_speed", "eccentricity"};
/// A column of the wheels times what its size may depend on: nothing that is named, but what a
/// wrong name leaves.
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
/// Ground that rises forward of the car is the plane on which its wheels roll as well.
inline constexpr std::array<std::string_view, 2> kGroundColumns{"height", "slope"};

/// Terms of a view's grammar: what a shift of the pixel may depend on. The first is the constant.
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
  std::size_t hinges = 0;  ///< number; their lines stand in the point of linearisation

  [[nodiscard]] std::size_t per_camera() const {
    return kCameraColumns.size() + 2 * kViewTermCount;
  }
  [[nodiscard]] std::size_t camera(std::size_t c) const { return c * per_camera(); }
  [[nodiscard]] std::size_t term(std::size_t c, std::size_t hook, std::size_t t) const {
    return camera(c) + kCameraColumns.size() + hook * kViewTermCount + t;
  }
  [[nodiscard]] std::size_t wheels() const { return camera(cameras); }
  [[nodiscard]] std::size_t variations() const { return wheels() + kWheelColumns.size(); }
  /// First of a hinge's columns.
  [[nodiscard]] std::size_t hinge(std::size_t h = 0) const {
    return variations() + kWheelVariations.size() + h * kHingeColumns;
  }
  [[nodiscard]] std::size_t ground() const { return hinge(hinges); }
  [[nodiscard]] std::size_t size() const { return ground() + kGroundColumns.size(); }
};

/// What a view's terms depend on beside its pixel: scaled so that each is about 1.
struct ViewFrame {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of the driven place [m]
  double reach_m = 1.0;
  double end_s = 1.0;
};
[[nodiscard]] ViewFrame view_frame(const ViewData& data);

/// Values of the grammar's terms for a pixel of `camera` (predicted) at pose `pose`.
[[nodiscard]] std::array<double, kViewTermCount> view_terms(const ViewFrame& frame,
                                                            const Camera& camera,
                                                            const Eigen::Vector2d& pixel,
                                                            const ViewMoment& moment,
                                                            const Eigen::Vector2d& place);
/// Value of a variation's covariate between two keyframes, about 1 in a car park; `end_s`: of the
/// drive.
[[nodiscard]] double covariate_value(std::string_view covariate,
                                     const ViewMoment& from,
                                     const ViewMoment& to,
                                     double end_s);
/// Unit vector from the middle of the camera's image to the pixel; its left normal is the
/// tangential direction.
[[nodiscard]] Eigen::Vector2d radial_direction(const Camera& camera, const Eigen::Vector2d& pixel);

}  // namespace roadbook
