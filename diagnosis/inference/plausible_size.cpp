#include "diagnosis/inference/plausible_size.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "sensors/effects.hpp"

namespace roadbook {

std::string likely_mistake(const std::string& effect, double size) {
  const bool of_radius = effect.ends_with("radius");
  const bool of_angle = effect == "imu0.gyro_scale" || effect == "steering0.ratio";
  if (!of_radius && !of_angle) return {};
  // A wheel that is larger than stated turns less: its readings are too small.
  const double factor = of_radius ? 1.0 / (1.0 + size) : 1.0 + size;
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  struct Mistake {
    double factor;
    const char* question;
  };
  std::vector<Mistake> mistakes{{-1.0, "sign reversed?"}};
  if (of_radius)
    mistakes.insert(mistakes.end(), {{3.6, "km/h taken for m/s?"},
                                     {1.0 / 3.6, "m/s taken for km/h?"},
                                     {2.0, "diameter stated for the radius?"},
                                     {0.5, "half the radius stated?"}});
  else
    mistakes.insert(mistakes.end(), {{kDegrees, "degrees taken for radians?"},
                                     {-kDegrees, "degrees taken for radians, and sign reversed?"},
                                     {1.0 / kDegrees, "radians taken for degrees?"}});
  for (const Mistake& m : mistakes)
    if (std::abs(factor / m.factor - 1.0) < 0.04) return m.question;
  return {};
}

std::string size_doubt(const FoundCause& cause) {
  const auto info = declared_effect(cause.effect);
  if (!info || std::abs(cause.size) <= kFarBeyondPlausible * info->plausible) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "doubtful: %.2g times the plausible size (%.3g%s); check unit and sign, or the "
                "true cause is not in the catalogue",
                std::abs(cause.size) / info->plausible, info->plausible,
                info->unit == "1" ? "" : (" " + std::string(info->unit)).c_str());
  const std::string mistake = likely_mistake(cause.effect, cause.size);
  return text + (mistake.empty() ? "" : "; " + mistake);
}

}  // namespace roadbook
