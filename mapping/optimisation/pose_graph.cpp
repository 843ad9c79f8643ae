#include "mapping/optimisation/pose_graph.hpp"

#include "base/require_option.hpp"

namespace roadbook {

void PoseGraphOptions::check() const {
  require_option(max_iterations >= 1, "max_iterations", max_iterations, "at least 1");
  require_option(relative_tolerance >= 0.0, "relative_tolerance", relative_tolerance, "at least 0");
  require_option(max_loop_chi2 > 0.0, "max_loop_chi2", max_loop_chi2, "above 0");
  require_option(gnc_factor > 1.0, "gnc_factor", gnc_factor, "above 1");
  require_option(cluster_span >= 0, "cluster_span", cluster_span, "at least 0");
  require_option(min_join_loops >= 1, "min_join_loops", min_join_loops, "at least 1");
  require_option(join_tolerance_m > 0.0, "join_tolerance_m", join_tolerance_m, "above 0");
  require_option(join_tolerance_rad > 0.0, "join_tolerance_rad", join_tolerance_rad, "above 0");
}

}  // namespace roadbook
