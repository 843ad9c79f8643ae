#pragma once

#include <string>

namespace roadbook {

/// "3.14": `value` with `decimals` decimals, whatever the locale; "-" where `value` is not finite.
[[nodiscard]] std::string fixed(double value, int decimals);

}  // namespace roadbook
