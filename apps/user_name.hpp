#pragma once

#include <string>

namespace roadbook {

/// In whose name something is done: `given`, that of option `--who`, or of who runs the program;
/// "labeller" where the system tells no name of 1 to 64 printable characters. Throws InvalidOption.
[[nodiscard]] std::string user_name(const std::string& given);

}  // namespace roadbook
