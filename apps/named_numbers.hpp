#pragma once

#include <map>
#include <string>
#include <vector>

namespace roadbook {

/// Reads the values of a repeated option NAME=NUMBER, such as `wheels0.radius=0.01`. Throws
/// InvalidOption with `want`.
[[nodiscard]] std::map<std::string, double> named_numbers(const std::string& option,
                                                          const std::vector<std::string>& texts,
                                                          const std::string& want);

}  // namespace roadbook
