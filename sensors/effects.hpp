#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Imperfections of sensors and world as named parameters that the nominal simulation holds at zero.
// The header of each sensor model declares the effects of that model; simulation applies them.

/// Declaration of one imperfection.
struct EffectInfo {
  std::string_view
      name;  ///< "SENSOR.EFFECT" as docs/reference/effects.md lists: "wheels0.left_radius"
  std::string_view unit;  ///< of the size: "1" (relative), "s", "m", "rad", "px"
  double plausible;       ///< practical size, either sign
  double lowest;          ///< no real sensor or place is beyond these: `check_effects` refuses such
  double highest;         ///< sizes, and a fit that ends there has not found its cause
  std::string_view
      covariate;  ///< what the effect grows with: "distance", "speed", "turn rate", ...
  std::string_view description;  ///< what it changes, one line
};

/// Sizes of the effects that are switched on, by name. A camera effect is declared once as
/// "cam.X" and applied to one camera as "cam2.X" or to all as "cam.X"; an effect of noise as
/// "STREAM.X" and applied as "imu0.X".
using EffectSizes = std::map<std::string, double>;

[[nodiscard]] std::span<const EffectInfo> wheel_effects();
[[nodiscard]] std::span<const EffectInfo> camera_effects();
[[nodiscard]] std::span<const EffectInfo> imu_effects();
[[nodiscard]] std::span<const EffectInfo> world_effects();    ///< ground, map, clock
[[nodiscard]] std::span<const EffectInfo> reading_effects();  ///< detector, friction, range
/// Of any stream's noise, declared as "STREAM.X": wheels0, steering0, imu0, poses, friction0,
/// range0.
[[nodiscard]] std::span<const EffectInfo> noise_effects();
/// All of them.
[[nodiscard]] std::vector<EffectInfo> all_effects();

/// Declaration of the effect that is called `name` ("cam2.focal", "imu0.outliers"); none: there is
/// no such effect.
[[nodiscard]] std::optional<EffectInfo> declared_effect(std::string_view name);

/// Size of `effect` for `sensor` ("cam2"): the sensor's own and that of the whole kind ("cam")
/// together; 0 where off.
[[nodiscard]] double effect_size(const EffectSizes& sizes,
                                 std::string_view sensor,
                                 std::string_view effect);

/// Throws BadInput naming the nearest known effect for a name that does not exist, and the bounds
/// for a size outside them, one camera's own and the rig's together included.
void check_effects(const EffectSizes& sizes);

}  // namespace roadbook
