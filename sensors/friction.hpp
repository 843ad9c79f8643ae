#pragma once

#include "sensors/effects.hpp"

namespace roadbook {

// Model of a friction sensor: its reading on a known surface, with imperfections.

/// Sizes of the effects "friction0.X" (units: sensors/reading_effects.cpp); all zero: the nominal
/// sensor, which reads the mean friction of the surface under the wheels.
template <typename T>
struct FrictionImperfections {
  T slip_bias{0.0};     ///< relative, at full use of the friction there is
  T speed_bias{0.0};    ///< [s/m]
  T drying{0.0};        ///< [1/s]
  T temperature{0.0};   ///< [1/K]
  T extra_class{0.0};   ///< additional friction on the surface with the wrong class
  T spatial_bias{0.0};  ///< standard deviation
};

[[nodiscard]] inline FrictionImperfections<double> friction_imperfections(
    const EffectSizes& sizes) {
  const auto size = [&](const char* effect) { return effect_size(sizes, "friction0", effect); };
  return {size("slip_bias"),   size("speed_bias"),  size("drying"),
          size("temperature"), size("extra_class"), size("spatial_bias")};
}

/// Where and when a reading was taken.
struct FrictionMoment {
  /// Horizontal acceleration of the car over that of gravity: the friction in use. The slip bias is
  /// relative to the friction and proportional to the used share of it. The product is proportional
  /// to the friction in use.
  double in_use = 0.0;
  double speed = 0.0;            ///< [m/s]
  double elapsed_s = 0.0;        ///< since the drive began
  double above_reference = 0.0;  ///< temperature less kFrictionReference [K]
  bool wet = false;              ///< water on the ground, which dries during the drive
  bool extra = false;            ///< on the surface with the wrong class
  double place = 0.0;            ///< bias of the place, of unit standard deviation
};

/// Temperature at which `friction0.temperature` changes nothing [degrees Celsius].
inline constexpr double kFrictionReference = 20.0;

/// Returns the friction read on a surface with friction `friction`.
template <typename T>
T predict_friction(const FrictionImperfections<T>& off, double friction, const FrictionMoment& at) {
  T read = T(friction) + off.slip_bias * T(at.in_use) + off.speed_bias * T(at.speed) +
           off.temperature * T(at.above_reference) + off.spatial_bias * T(at.place);
  if (at.wet) read += off.drying * T(at.elapsed_s);
  if (at.extra) read += off.extra_class;
  return read;
}

}  // namespace roadbook
