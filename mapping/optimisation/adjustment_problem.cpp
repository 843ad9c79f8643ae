#include "mapping/optimisation/adjustment_problem.hpp"

#include "base/require_option.hpp"

namespace roadbook {

void BundleOptions::check() const {
  require_option(max_iterations >= 1, "max_iterations", max_iterations, "at least 1");
  require_option(relative_tolerance >= 0.0, "relative_tolerance", relative_tolerance, "at least 0");
  require_option(loss_width > 0.0, "loss_width", loss_width, "above 0");
  require_option(motion_loss_width > 0.0, "motion_loss_width", motion_loss_width, "above 0");
  require_option(ground_sigma_m > 0.0, "ground_sigma_m", ground_sigma_m, "above 0");
  require_option(outlier_rounds >= 0, "outlier_rounds", outlier_rounds, "at least 0");
  require_option(max_chi2 > 0.0, "max_chi2", max_chi2, "above 0");
  require_option(num_threads >= 0, "num_threads", num_threads, "at least 0");
}

}  // namespace roadbook
