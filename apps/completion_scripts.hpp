#pragma once

#include <string>

namespace roadbook {

/// Completion script for bash: verbs, options, choices and files.
[[nodiscard]] std::string bash_completion();

/// The same for zsh.
[[nodiscard]] std::string zsh_completion();

}  // namespace roadbook
