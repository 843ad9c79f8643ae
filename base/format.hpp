#pragma once

#include <string>

namespace roadbook {

/// "3.14": with so many decimals, whatever the locale; "-" for what is not finite.
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace roadbook
