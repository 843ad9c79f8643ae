#pragma once

#include <string>

namespace roadbook {

/// Who runs the program, at most 64 bytes; "labeller" where the system does not tell.
[[nodiscard]] std::string user_name();

}  // namespace roadbook
