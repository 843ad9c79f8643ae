#include "mapping/optimisation/pose_graph_solver.hpp"

#include <ceres/loss_function.h>

#include <cmath>

#include "base/index.hpp"
#include "mapping/optimisation/ceres_motion_cost.hpp"
#include "mapping/optimisation/ceres_solve.hpp"

namespace roadbook {
namespace {

double scale_of(const RelativePose& edge, const GraphState& state) {
  return edge.scale < 0 ? 1.0 : state.scales[at(edge.scale)];
}

// Nearly Gauss-Newton from the first step: poses chained by odometry are good start values.
constexpr double kTrustRegionRadius = 1e8;

}  // namespace

double edge_chi2(const RelativePose& edge, const GraphState& state) {
  if (!state.log_scales.empty()) {
    const double from = state.log_scales[at(edge.from)];
    const Vector6d e = scaled_motion_residual(state.poses[at(edge.from)], state.poses[at(edge.to)],
                                              edge.T_from_to, from)
                           .r;
    const double scale =
        edge.log_scale_sigma > 0.0
            ? (state.log_scales[at(edge.to)] - from - edge.log_scale) / edge.log_scale_sigma
            : 0.0;
    return e.dot(edge.information * e) + scale * scale;
  }
  const Vector6d r = motion_error(state.poses[at(edge.from)], state.poses[at(edge.to)],
                                  edge.T_from_to, scale_of(edge, state));
  return r.dot(edge.information * r);
}

double graph_chi2(const PoseGraph& graph,
                  const std::vector<WeightedEdge>& edges,
                  const GraphState& state) {
  double chi2 = 0.0;
  for (const WeightedEdge& e : edges)
    if (e.weight > 0.0) chi2 += e.weight * edge_chi2(*e.edge, state);
  for (std::size_t s = 0; s < graph.scales.size(); ++s) {
    if (graph.scales[s].fixed) continue;
    const double r = (state.scales[s] - graph.scales[s].prior) / graph.scales[s].prior_sigma;
    chi2 += r * r;
  }
  for (std::size_t i = 0; i < graph.pose_scales.size(); ++i) {
    const PoseScale& scale = graph.pose_scales[i];
    if (scale.fixed || !(scale.prior_sigma > 0.0)) continue;
    const double r = (state.log_scales[i] - scale.prior) / scale.prior_sigma;
    chi2 += std::log1p(r * r);  // Cauchy
  }
  return chi2;
}

struct GraphSolver::Unknowns {
  std::size_t fixed;
  std::vector<PoseBlock> poses;
  std::vector<double> scales;
  std::vector<double> log_scales;  // of the poses
  std::vector<double> weights;     // of the edges
  PoseManifold manifold;
  ceres::CauchyLoss scale_loss{1.0};
  ceres::Problem problem{ceres_problem_options()};

  Unknowns(const PoseGraph& graph, const std::vector<const RelativePose*>& edges)
      : fixed(at(graph.fixed)),
        poses(graph.T_map_vehicle.size()),
        scales(graph.scales.size()),
        log_scales(graph.pose_scales.size()),
        weights(edges.size(), 1.0) {
    for (PoseBlock& pose : poses) problem.AddParameterBlock(pose.data(), 7, &manifold);
    problem.SetParameterBlockConstant(poses[fixed].data());
    for (std::size_t i = 0; i < log_scales.size(); ++i)
      add_pose_scale(graph.pose_scales[i], &log_scales[i]);
    for (std::size_t k = 0; k < edges.size(); ++k) add_edge(*edges[k], &weights[k]);
    for (std::size_t s = 0; s < scales.size(); ++s) add_prior(graph.scales[s], &scales[s]);
  }

  void add_pose_scale(const PoseScale& scale, double* value) {
    problem.AddParameterBlock(value, 1);
    if (scale.prior_sigma > 0.0)
      problem.AddResidualBlock(new ScalePriorCost(scale.prior, scale.prior_sigma), &scale_loss,
                               value);
    if (scale.fixed) problem.SetParameterBlockConstant(value);
  }
  void add_edge(const RelativePose& edge, const double* weight) {
    if (!log_scales.empty()) {
      problem.AddResidualBlock(new ScaledMotionCost(edge, weight), nullptr,
                               poses[at(edge.from)].data(), poses[at(edge.to)].data(),
                               &log_scales[at(edge.from)], &log_scales[at(edge.to)]);
      return;
    }
    const bool has_scale = edge.scale >= 0;
    std::vector<double*> blocks{poses[at(edge.from)].data(), poses[at(edge.to)].data()};
    if (has_scale) blocks.push_back(&scales[at(edge.scale)]);
    problem.AddResidualBlock(new MotionCost(edge.T_from_to, edge.information, has_scale, weight),
                             nullptr, blocks);
  }
  void add_prior(const ScaleParameter& scale, double* value) {
    problem.AddResidualBlock(new ScalePriorCost(scale.prior, scale.prior_sigma), nullptr, value);
    if (scale.fixed) problem.SetParameterBlockConstant(value);
  }
  void set(const GraphState& state, const std::vector<WeightedEdge>& edges) {
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = block_of(state.poses[i]);
    scales = state.scales;
    log_scales = state.log_scales;
    for (std::size_t k = 0; k < edges.size(); ++k) weights[k] = edges[k].weight;
  }
};

GraphSolver::GraphSolver(const PoseGraph& graph, std::vector<const RelativePose*> edges)
    : unknowns_(std::make_unique<Unknowns>(graph, edges)) {}
GraphSolver::~GraphSolver() = default;

GraphSolver::Outcome GraphSolver::minimise(const std::vector<WeightedEdge>& edges,
                                           GraphState& state,
                                           int max_iterations,
                                           double relative_tolerance) {
  unknowns_->set(state, edges);
  const CeresOutcome outcome = solve_by_ceres(
      ceres_solver_options(ceres::SPARSE_NORMAL_CHOLESKY, max_iterations, kTrustRegionRadius),
      relative_tolerance, {}, unknowns_->problem);
  for (std::size_t i = 0; i < state.poses.size(); ++i)
    if (i != unknowns_->fixed) state.poses[i] = pose_of(unknowns_->poses[i].data());
  state.scales = unknowns_->scales;
  state.log_scales = unknowns_->log_scales;
  return {outcome.iterations, outcome.converged};
}

}  // namespace roadbook
