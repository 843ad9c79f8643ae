#include "mapping/optimisation/bundle_adjustment_ceres.hpp"

#include <ceres/loss_function.h>
#include <ceres/ordered_groups.h>

#include <memory>

#include "base/index.hpp"
#include "mapping/optimisation/ceres_motion_cost.hpp"
#include "mapping/optimisation/ceres_solve.hpp"

namespace roadbook {
namespace {

using Jacobian27 = Eigen::Matrix<double, 2, 7, Eigen::RowMajor>;
using Jacobian23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;

// Residual of one pixel or ground height. Parameter blocks: pose, point.
class TermCost : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  TermCost(const BundleProblem& problem, const BundleTerm& term, double invalid_residual)
      : problem_(problem), term_(term), invalid_residual_(invalid_residual) {}

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Vector3d p_map = Eigen::Map<const Eigen::Vector3d>(parameters[1]);
    const TermResidual e =
        term_residual(problem_, term_, pose_of(parameters[0]), p_map, jacobians != nullptr);
    residuals[0] = e.valid ? e.r.x() : invalid_residual_;
    residuals[1] = e.r.y();
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      Eigen::Map<Jacobian27> J(jacobians[0]);
      J.leftCols<6>() = e.J_pose;
      J.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Jacobian23> J(jacobians[1]);
      J = e.J_point;
    }
    return true;
  }

 private:
  const BundleProblem& problem_;
  const BundleTerm& term_;
  double invalid_residual_;
};

std::unique_ptr<ceres::LossFunction> loss_of(const BundleOptions& options) {
  switch (options.loss) {
    case RobustLoss::kHuber:
      return std::make_unique<ceres::HuberLoss>(options.loss_width);
    case RobustLoss::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(options.loss_width);
    case RobustLoss::kNone:
      break;
  }
  return std::make_unique<ceres::TrivialLoss>();
}

std::unique_ptr<ceres::LossFunction> motion_loss_of(const BundleOptions& options) {
  if (options.loss == RobustLoss::kNone) return std::make_unique<ceres::TrivialLoss>();
  return std::make_unique<ceres::HuberLoss>(options.motion_loss_width);
}

// The bundle problem as parameter and residual blocks.
struct BundleBlocks {
  std::vector<PoseBlock> poses;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> scales;
  PoseManifold manifold;
  std::unique_ptr<ceres::LossFunction> loss;
  std::unique_ptr<ceres::LossFunction> motion_loss;
  ceres::Problem problem{ceres_problem_options()};
  std::shared_ptr<ceres::ParameterBlockOrdering> order =
      std::make_shared<ceres::ParameterBlockOrdering>();

  BundleBlocks(const BundleProblem& bundle,
               const BundleLayout& layout,
               const BundleOptions& options,
               const BundleState& state)
      : points(state.points),
        scales(state.scales),
        loss(loss_of(options)),
        motion_loss(motion_loss_of(options)) {
    poses.reserve(state.poses.size());
    for (const Eigen::Isometry3d& T : state.poses) poses.push_back(block_of(T));
    add_poses(layout);
    add_scales(bundle);
    add_terms(bundle, layout, options);
    add_motions(bundle);
  }

  void add_poses(const BundleLayout& layout) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      problem.AddParameterBlock(poses[i].data(), 7, &manifold);
      if (layout.variable[i] < 0) problem.SetParameterBlockConstant(poses[i].data());
      order->AddElementToGroup(poses[i].data(), 1);
    }
  }
  void add_scales(const BundleProblem& bundle) {
    for (std::size_t s = 0; s < scales.size(); ++s) {
      const ScaleParameter& scale = bundle.scales[s];
      problem.AddResidualBlock(new ScalePriorCost(scale.prior, scale.prior_sigma), nullptr,
                               &scales[s]);
      if (scale.fixed) problem.SetParameterBlockConstant(&scales[s]);
      order->AddElementToGroup(&scales[s], 1);
    }
  }
  void add_terms(const BundleProblem& bundle,
                 const BundleLayout& layout,
                 const BundleOptions& options) {
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (layout.term_begin[p] == layout.term_begin[p + 1]) continue;
      for (std::size_t t = layout.term_begin[p]; t < layout.term_begin[p + 1]; ++t) {
        const BundleTerm& term = layout.terms[t];
        problem.AddResidualBlock(new TermCost(bundle, term, 10.0 * options.loss_width), loss.get(),
                                 poses[at(term.pose)].data(), points[p].data());
      }
      if (layout.point_free[p] == 0) problem.SetParameterBlockConstant(points[p].data());
      order->AddElementToGroup(points[p].data(), 0);
    }
  }
  void add_motions(const BundleProblem& bundle) {
    for (const MotionConstraint& m : bundle.motions) {
      std::vector<double*> blocks{poses[at(m.from)].data(), poses[at(m.to)].data()};
      if (m.scale >= 0) blocks.push_back(&scales[at(m.scale)]);
      problem.AddResidualBlock(new MotionCost(m.T_from_to, m.information, m.scale >= 0),
                               motion_loss.get(), blocks);
    }
    for (const PosePrior& prior : bundle.priors)
      problem.AddResidualBlock(new PosePriorCost(prior.T_map_vehicle, prior.information), nullptr,
                               poses[at(prior.pose)].data());
  }
  void write_to(const BundleLayout& layout, BundleState& state) const {
    for (const int i : layout.pose_of) state.poses[at(i)] = pose_of(poses[at(i)].data());
    state.points = points;
    state.scales = scales;
  }
};

}  // namespace

BundleMinimum minimise_by_ceres(const BundleProblem& problem,
                                const BundleLayout& layout,
                                const BundleOptions& options,
                                BundleState& state,
                                const Progress& progress) {
  constexpr double kFirstTrustRegionRadius =
      1e4;  // inverse of the damping that our own solver begins with
  BundleMinimum minimum;
  minimum.initial_cost = bundle_cost(problem, layout, state, options);
  BundleBlocks blocks(problem, layout, options, state);
  ceres::Solver::Options solver =
      ceres_solver_options(ceres::SPARSE_SCHUR, options.max_iterations, kFirstTrustRegionRadius);
  solver.linear_solver_ordering = blocks.order;
  const CeresOutcome outcome = solve_by_ceres(
      solver, options.relative_tolerance,
      [&](int iteration) {
        report(progress, "bundle adjustment", at(iteration), at(options.max_iterations));
      },
      blocks.problem);
  blocks.write_to(layout, state);
  minimum.final_cost = bundle_cost(problem, layout, state, options);
  minimum.iterations = outcome.iterations;
  minimum.converged = outcome.converged;
  return minimum;
}

}  // namespace roadbook
