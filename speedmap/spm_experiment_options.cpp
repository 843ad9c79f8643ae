#include "speedmap/spm_experiment_options.hpp"

namespace roadbook {
void SpmExperimentOptions::check() const {}
}  // namespace roadbook
