#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/console.hpp"
#include "workflows/calibration/calibrate_drives.hpp"

namespace roadbook {

/// One line a column: name, old value, new value with its 95 % interval.
[[nodiscard]] std::vector<std::string> calibration_lines(const CalibrateResult& result);

/// Prints the calibration. `model`: the file that was written, unless the result was refused.
void print_calibration(const Console& console,
                       const CalibrateResult& result,
                       const std::filesystem::path& model);

}  // namespace roadbook
