#pragma once

#include <string>

namespace roadbook {

/// Returns the name of the user who makes a change. This is `given`, the value of option `--who`,
/// or the login name. It is "labeller" if the system gives no name of 1 to 64 printable characters.
/// Throws InvalidOption.
[[nodiscard]] std::string user_name(const std::string& given);

}  // namespace roadbook
