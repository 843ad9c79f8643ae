#include "mapping/optimisation/ceres_solve.hpp"

#include <exception>

namespace roadbook {
namespace {

class IterationWatch : public ceres::IterationCallback {
 public:
  IterationWatch(double relative_tolerance, const std::function<void(int)>& on_iteration)
      : relative_tolerance_(relative_tolerance), on_iteration_(on_iteration) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& s) override {
    try {
      if (on_iteration_) on_iteration_(s.iteration);
    } catch (...) {
      thrown_ = std::current_exception();
      return ceres::SOLVER_ABORT;
    }
    const bool is_small = s.iteration > 0 && s.step_is_successful &&
                          s.cost_change <= relative_tolerance_ * (s.cost + s.cost_change);
    return is_small ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }
  void throw_again() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  double relative_tolerance_;
  const std::function<void(int)>& on_iteration_;
  std::exception_ptr thrown_;
};

}  // namespace

ceres::Problem::Options ceres_problem_options() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

ceres::Solver::Options ceres_solver_options(ceres::LinearSolverType linear_solver,
                                            int max_iterations,
                                            double initial_trust_region_radius) {
  ceres::Solver::Options options;
  options.linear_solver_type = linear_solver;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.initial_trust_region_radius = initial_trust_region_radius;
  options.function_tolerance = 1e-15;  // IterationWatch stops earlier
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 0.0;
  options.logging_type = ceres::SILENT;
  return options;
}

CeresOutcome solve_by_ceres(ceres::Solver::Options options,
                            double relative_tolerance,
                            const std::function<void(int)>& on_iteration,
                            ceres::Problem& problem) {
  IterationWatch watch(relative_tolerance, on_iteration);
  options.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  watch.throw_again();
  const bool converged = summary.termination_type == ceres::CONVERGENCE ||
                         summary.termination_type == ceres::USER_SUCCESS;
  return {static_cast<int>(summary.iterations.size()) - 1, converged};
}

}  // namespace roadbook
