#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

// Drives of cars that log further columns, one of which influences a sensor. They are written as
// plain logs (CSV and YAML); diagnosis gets the files only.

/// A further signal of the car and its column in the log.
struct CarSignal {
  std::string name;
  std::string unit;
  double period_s = 0.1;
  double resolution = 0.0;  ///< quantisation of the logged value; 0: exact
  double mean = 0.0;
  double spread = 1.0;
  std::function<double(double t_s)> of;  ///< in units of `spread`, less `mean`
};

/// Battery voltage, tyre temperature and gear, drawn at random; none is a function of time or
/// motion.
[[nodiscard]] std::vector<CarSignal> draw_signals(std::uint64_t seed);

/// Effects outside the catalogue: "outside.gyro_scale_by_column", "outside.gyro_bias_by_column",
/// "outside.wheels_by_column". Sizes are per standard deviation of the signal. `hook`: stream that
/// diagnosis may report.
struct ColumnEffect {
  EffectRange range;
  std::string hook;
};
[[nodiscard]] const std::vector<ColumnEffect>& column_effects();

/// Writes recording and signals as tables with a description "log.yaml"; returns the description's
/// path.
[[nodiscard]] std::filesystem::path write_plain_log(const Recording& recording,
                                                    const std::vector<CarSignal>& signals,
                                                    const std::filesystem::path& folder);

}  // namespace roadbook::test
