#pragma once

#include <string>

namespace roadbook {

/// Returns the completion script for bash: verbs, options, choices and files.
[[nodiscard]] std::string bash_completion();

/// Returns the same script for zsh.
[[nodiscard]] std::string zsh_completion();

}  // namespace roadbook
