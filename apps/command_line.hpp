#pragma once

#include <string>
#include <vector>

#include "apps/options.hpp"

namespace roadbook {

/// Fills `options` from the words after the verb. Returns false where `--help` was asked for: it
/// has been printed on standard output. Throws InvalidOption for what does not fit, naming the
/// nearest option where one was meant.
bool parse_command_line(const std::string& verb,
                        const std::string& summary,
                        const std::vector<std::string>& words,
                        Options& options);

}  // namespace roadbook
