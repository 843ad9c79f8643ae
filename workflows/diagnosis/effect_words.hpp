#pragma once

#include <optional>
#include <string_view>

namespace roadbook {

/// An effect in the words of those who keep the car, for each effect of the catalogue.
struct EffectWords {
  std::string_view effect;  ///< as declared: "wheels0.radius", "cam.pitch", "STREAM.outliers"
  std::string_view noun;    ///< what was checked: "wheel radius"
  std::string_view more;    ///< what is wrong if the size is positive; {sensor} is its name
  std::string_view less;    ///< if it is negative; empty: as `more`
  std::string_view unit;    ///< shown: "%", "mm", "deg", "ms"
  double factor = 1.0;      ///< from the effect's own unit to the shown one
  /// What to do. {size} and {-size} are the shown size, {factor} is 1 + the size,
  /// {left}, {right}, {track} and {wheelbase} are new values of the vehicle, {left_key} ... the
  /// names of their keys, {calibrate} says new values of a camera. A sentence whose value is not
  /// stated is left out.
  std::string_view act;
  bool of_place = false;  ///< a feature of the place, not a fault of a sensor
};

/// The words of an effect ("cam2.pitch", "imu0.outliers"); empty if there is no such effect.
/// `of_log`: of a plain log, which has no cameras.
[[nodiscard]] std::optional<EffectWords> effect_words(std::string_view name, bool of_log = false);

/// What a drive must contain for effects that grow with a covariate, as an order to the driver:
/// "drive the same street at 5 and at 20 m/s".
[[nodiscard]] std::string_view drive_that_shows(std::string_view covariate);

}  // namespace roadbook
