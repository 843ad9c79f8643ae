#include "base/format.hpp"

#include <charconv>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  char text[400];  // the largest double has 309 digits before the point
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
  ROADBOOK_ASSERT(end.ec == std::errc{});
  return {text, end.ptr};
}

}  // namespace roadbook
