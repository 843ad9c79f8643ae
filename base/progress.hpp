#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

namespace roadbook {

/// A callback that long stages call with their name, the items done and the items in total (0:
/// unknown). If it returns false, the stage stops and throws Interrupted. Called from one thread at
/// a time.
using Progress = std::function<bool(std::string_view stage, std::size_t done, std::size_t total)>;

/// Calls `progress` if it is not empty. Throws Interrupted if it returns false.
void report(const Progress& progress, std::string_view stage, std::size_t done, std::size_t total);

}  // namespace roadbook
