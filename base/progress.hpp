#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace roadbook {

/// Called by long stages: name of the stage, items done, items in total (0: unknown). Returning
/// false asks the stage to stop; it then throws Interrupted. Called from one thread at a time.
using Progress = std::function<bool(std::string_view stage, std::size_t done, std::size_t total)>;

/// Reports to `progress` where there is one; throws Interrupted if it returns false.
void report(const Progress& progress, std::string_view stage, std::size_t done, std::size_t total);

}  // namespace roadbook
