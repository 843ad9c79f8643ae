#include "diagnosis/inference/plausible_size.hpp"

#include <cmath>
#include <cstdio>

#include "sensors/effects.hpp"

namespace roadbook {

std::string size_doubt(const FoundCause& cause) {
  const auto info = declared_effect(cause.effect);
  if (!info || std::abs(cause.size) <= kFarBeyondPlausible * info->plausible) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "doubtful: %.2g times the plausible size (%.3g%s); check unit and sign, or the "
                "true cause is not in the catalogue",
                std::abs(cause.size) / info->plausible, info->plausible,
                info->unit == "1" ? "" : (" " + std::string(info->unit)).c_str());
  return text;
}

}  // namespace roadbook
