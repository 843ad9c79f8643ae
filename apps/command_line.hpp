#pragma once

#include <string>
#include <vector>

#include "apps/options.hpp"

namespace roadbook {

/// Fills `options` from the words after the verb. Returns false after `--help`, which it prints on
/// standard output. Throws InvalidOption for invalid words, with the name of the nearest option.
bool parse_command_line(const std::string& verb,
                        const std::string& summary,
                        const std::vector<std::string>& words,
                        Options& options);

}  // namespace roadbook
