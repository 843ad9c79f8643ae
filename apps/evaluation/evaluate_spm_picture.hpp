#pragma once

#include <string>

#include "speedmap/experiments/spm_experiment_options.hpp"

namespace roadbook {

/// A stretch of the experiment's first map as SVG: true friction, what the map believes after 200 m
/// of driving, and its standard deviation; with the driven line and the probe horizon.
[[nodiscard]] std::string spm_picture(const SpmExperimentOptions& options);

}  // namespace roadbook
