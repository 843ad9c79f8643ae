#pragma once

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <functional>

namespace roadbook {

// Options and stopping rule that all uses of Ceres share.

/// Options of a problem that owns its cost functions, while the caller owns manifolds and losses.
[[nodiscard]] ceres::Problem::Options ceres_problem_options();

/// Options of a solve that depends on `relative_tolerance` and `max_iterations` alone.
///
/// One thread: the sum of the cost over several threads depends on their timing. Eigen's sparse
/// Cholesky: the bits of CHOLMOD's depend on the installed BLAS.
[[nodiscard]] ceres::Solver::Options ceres_solver_options(ceres::LinearSolverType linear_solver,
                                                          int max_iterations,
                                                          double initial_trust_region_radius);

struct CeresOutcome {
  int iterations = 0;  ///< linear solves
  bool converged = false;
};

/// Solves until a step lowers the cost by less than `relative_tolerance` of it; that step is still
/// taken (Ceres' own function tolerance would drop it). `on_iteration` is called with the number
/// of linear solves so far; what it throws ends the solve and is thrown again.
CeresOutcome solve_by_ceres(ceres::Solver::Options options,
                            double relative_tolerance,
                            const std::function<void(int)>& on_iteration,
                            ceres::Problem& problem);

}  // namespace roadbook
