#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Imperfections of sensors and surroundings as named parameters ("effects"). All are zero in the
// nominal simulation. The headers of the sensor models apply them (wheel_imperfections.hpp, ...).

/// Declaration of one effect.
struct EffectInfo {
  std::string_view
      name;  ///< "SENSOR.EFFECT" as docs/reference/effects.md lists: "wheels0.left_radius"
  std::string_view unit;  ///< of the size: "1" (relative), "s", "m", "rad", "px"
  double plausible;       ///< size of real sensors and places, with either sign
  double lowest;          ///< lower bound of the size; `check_effects` refuses sizes outside
  double highest;         ///< upper bound; a fit that ends here has not found the cause
  std::string_view
      covariate;  ///< what the effect grows with: "distance", "speed", "turn rate", ...
  std::string_view description;  ///< what it changes, one line
};

/// Sizes of the effects that are on, by name. A camera effect is declared once as "cam.X". It is
/// applied to all cameras as "cam.X" or to one camera as "cam2.X". An effect of noise is declared
/// as "STREAM.X" and applied as "imu0.X".
using EffectSizes = std::map<std::string, double>;

[[nodiscard]] std::span<const EffectInfo> wheel_effects();
[[nodiscard]] std::span<const EffectInfo> camera_effects();
[[nodiscard]] std::span<const EffectInfo> imu_effects();
[[nodiscard]] std::span<const EffectInfo> world_effects();    ///< ground, map, clock
[[nodiscard]] std::span<const EffectInfo> reading_effects();  ///< detector, friction, range
/// Effects of the noise of a stream, declared as "STREAM.X". STREAM is wheels0, steering0, imu0,
/// poses, friction0 or range0.
[[nodiscard]] std::span<const EffectInfo> noise_effects();
/// All of them.
[[nodiscard]] std::vector<EffectInfo> all_effects();

/// Returns the declaration of effect `name` ("cam2.focal", "imu0.outliers"); empty if there is no
/// such effect.
[[nodiscard]] std::optional<EffectInfo> declared_effect(std::string_view name);

/// Returns the size of `effect` ("focal") for `sensor` ("cam2"): the sum of the sensor's own size
/// and the size for its whole kind ("cam"); 0 if both are off.
[[nodiscard]] double effect_size(const EffectSizes& sizes,
                                 std::string_view sensor,
                                 std::string_view effect);

/// Whether an effect changes cameras: "cam.focal", "cam2.latency", "rig.pitch".
[[nodiscard]] bool is_camera_effect(std::string_view name);

/// Checks names and sizes. Throws BadInput, with the nearest known effect for an unknown name, and
/// with the bounds for a size outside them. Sizes of one camera and of the whole rig are added
/// first.
void check_effects(const EffectSizes& sizes);

}  // namespace roadbook
