#include "apps/summaries/offset_text.hpp"

#include <numbers>

#include "base/format.hpp"

namespace roadbook {

std::string offset_text(const std::optional<SessionOffset>& offset) {
  if (!offset) return "-";
  std::string text = fixed(offset->shift_m.norm(), 3) + " m";
  if (offset->heading_rad)
    text += ", " + fixed(*offset->heading_rad * 180.0 / std::numbers::pi, 3) + " deg";
  return text;
}

}  // namespace roadbook
