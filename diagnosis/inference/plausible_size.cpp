#include "diagnosis/inference/plausible_size.hpp"

#include <cmath>
#include <cstdio>

#include "sensors/effects.hpp"

namespace roadbook {

std::string size_doubt(const FoundCause& cause) {
  const auto info = declared_effect(cause.effect);
  if (!info || std::abs(cause.size) <= kFarBeyondPlausible * info->plausible) return {};
  char text[160];
  std::snprintf(
      text, sizeof text,
      "doubtful: %.2g times what is plausible (%.3g%s): unit, sign or a cause not listed?",
      std::abs(cause.size) / info->plausible, info->plausible,
      info->unit == "1" ? "" : (" " + std::string(info->unit)).c_str());
  return text;
}

}  // namespace roadbook
