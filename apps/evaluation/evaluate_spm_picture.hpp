#pragma once

#include <string>

#include "speedmap/experiments/spm_experiment_options.hpp"

namespace roadbook {

/// Draws a section of the experiment's first map as SVG. It shows the true friction, the estimated
/// mean after 200 m of driving, and its standard deviation. It also shows the driven line and the
/// probe horizon.
[[nodiscard]] std::string spm_picture(const SpmExperimentOptions& options);

}  // namespace roadbook
