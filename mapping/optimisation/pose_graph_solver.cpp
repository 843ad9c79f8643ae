#include "mapping/optimisation/pose_graph_solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "mapping/optimisation/block_cholesky.hpp"

namespace roadbook {
namespace {

double scale_of(const RelativePose& edge, const GraphState& state) {
  return edge.scale < 0 ? 1.0 : state.scales[at(edge.scale)];
}

// The fixed pose has no unknowns; those after it move up by one.
int variable_of(int pose, int fixed) {
  if (pose == fixed) return -1;
  return pose < fixed ? pose : pose - 1;
}

std::vector<std::pair<int, int>> coupled(const std::vector<const RelativePose*>& edges, int fixed) {
  std::vector<std::pair<int, int>> pairs;
  for (const RelativePose* edge : edges)
    if (edge->from != fixed && edge->to != fixed)
      pairs.emplace_back(variable_of(edge->from, fixed), variable_of(edge->to, fixed));
  return pairs;
}

}  // namespace

double edge_chi2(const RelativePose& edge, const GraphState& state) {
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
  return chi2;
}

struct GraphSolver::System {
  const PoseGraph& graph;
  int num_threads;
  BlockCholesky H;
  Eigen::VectorXd b;
  std::vector<Matrix6d> diagonal;
  // The scales border the matrix of the poses.
  Eigen::MatrixXd border;
  Eigen::VectorXd scale_H;
  Eigen::VectorXd scale_b;

  System(const PoseGraph& g, const std::vector<const RelativePose*>& edges, int threads)
      : graph(g),
        num_threads(threads),
        H(g.T_map_vehicle.size() - 1, coupled(edges, g.fixed)),
        diagonal(H.size()) {}

  void linearise(const std::vector<WeightedEdge>& edges, const GraphState& state);
  void add_edge(const RelativePose& edge, double weight, const GraphState& state);
  bool solve(double lambda, Eigen::VectorXd& dx, Eigen::VectorXd& ds);
  [[nodiscard]] double model_decrease(double lambda,
                                      const Eigen::VectorXd& dx,
                                      const Eigen::VectorXd& ds) const;
  [[nodiscard]] GraphState moved(const GraphState& state,
                                 const Eigen::VectorXd& dx,
                                 const Eigen::VectorXd& ds) const;
  std::vector<std::pair<std::pair<int, int>, Matrix6d>> off_diagonal;
};

void GraphSolver::System::add_edge(const RelativePose& edge,
                                   double weight,
                                   const GraphState& state) {
  const MotionResidual e = motion_residual(state.poses[at(edge.from)], state.poses[at(edge.to)],
                                           edge.T_from_to, scale_of(edge, state));
  const Matrix6d A = weight * e.J_from.transpose() * edge.information;
  const Matrix6d B = weight * e.J_to.transpose() * edge.information;
  const int i = variable_of(edge.from, graph.fixed);
  const int j = variable_of(edge.to, graph.fixed);
  if (i >= 0) {
    diagonal[at(i)] += A * e.J_from;
    b.segment<6>(6 * i) -= A * e.r;
  }
  if (j >= 0) {
    diagonal[at(j)] += B * e.J_to;
    b.segment<6>(6 * j) -= B * e.r;
  }
  if (i >= 0 && j >= 0) off_diagonal.push_back({{i, j}, A * e.J_to});
  if (edge.scale < 0 || graph.scales[at(edge.scale)].fixed) return;
  if (i >= 0) border.col(edge.scale).segment<6>(6 * i) += A * e.J_scale;
  if (j >= 0) border.col(edge.scale).segment<6>(6 * j) += B * e.J_scale;
  scale_H(edge.scale) += weight * e.J_scale.dot(edge.information * e.J_scale);
  scale_b(edge.scale) -= weight * e.J_scale.dot(edge.information * e.r);
}

void GraphSolver::System::linearise(const std::vector<WeightedEdge>& edges,
                                    const GraphState& state) {
  const auto rows = static_cast<Eigen::Index>(6 * H.size());
  const auto scales = static_cast<Eigen::Index>(graph.scales.size());
  b.setZero(rows);
  border.setZero(rows, scales);
  scale_H.setZero(scales);
  scale_b.setZero(scales);
  off_diagonal.clear();
  std::fill(diagonal.begin(), diagonal.end(), Matrix6d::Zero());
  for (const WeightedEdge& e : edges)
    if (e.weight > 0.0) add_edge(*e.edge, e.weight, state);
  for (Eigen::Index s = 0; s < scales; ++s) {
    const ScaleParameter& scale = graph.scales[static_cast<std::size_t>(s)];
    const double sigma = scale.fixed ? 1e-9 : scale.prior_sigma;
    const double value = state.scales[static_cast<std::size_t>(s)];
    scale_H(s) += 1.0 / (sigma * sigma);
    if (!scale.fixed) scale_b(s) -= (value - scale.prior) / (sigma * sigma);
  }
}

bool GraphSolver::System::solve(double lambda, Eigen::VectorXd& dx, Eigen::VectorXd& ds) {
  H.set_zero();
  for (std::size_t v = 0; v < diagonal.size(); ++v) {
    Matrix6d damped = diagonal[v];
    // Poses that no edge holds at present must not make the matrix singular: the absolute part.
    for (int i = 0; i < 6; ++i) damped(i, i) += lambda * diagonal[v](i, i) + 1e-9;
    H.add(static_cast<int>(v), static_cast<int>(v), damped);
  }
  for (const auto& [pair, value] : off_diagonal) H.add(pair.first, pair.second, value);
  if (!H.factor(num_threads)) return false;
  dx = b;
  H.solve(dx);
  ds = Eigen::VectorXd::Zero(scale_b.size());
  if (scale_b.size() == 0) return dx.allFinite();
  Eigen::MatrixXd X(border.rows(), border.cols());
  for (Eigen::Index s = 0; s < border.cols(); ++s) {
    Eigen::VectorXd x = border.col(s);
    H.solve(x);
    X.col(s) = x;
  }
  Eigen::MatrixXd C = -border.transpose() * X;
  C.diagonal() += (1.0 + lambda) * scale_H;
  const Eigen::LLT<Eigen::MatrixXd> llt(C);
  if (llt.info() != Eigen::Success) return false;
  ds = llt.solve(scale_b - border.transpose() * dx);
  dx -= X * ds;
  return dx.allFinite() && ds.allFinite();
}

double GraphSolver::System::model_decrease(double lambda,
                                           const Eigen::VectorXd& dx,
                                           const Eigen::VectorXd& ds) const {
  double sum = dx.dot(b) + ds.dot(scale_b);
  for (std::size_t v = 0; v < diagonal.size(); ++v)
    for (int i = 0; i < 6; ++i) {
      const double d = dx(static_cast<Eigen::Index>(6 * v) + i);
      sum += lambda * diagonal[v](i, i) * d * d;
    }
  return sum + lambda * ds.dot(scale_H.cwiseProduct(ds));
}

GraphState GraphSolver::System::moved(const GraphState& state,
                                      const Eigen::VectorXd& dx,
                                      const Eigen::VectorXd& ds) const {
  GraphState next = state;
  for (std::size_t i = 0; i < next.poses.size(); ++i) {
    const int v = variable_of(static_cast<int>(i), graph.fixed);
    if (v < 0) continue;
    Eigen::Isometry3d& T = next.poses[i];
    T = T * se3_exp(dx.segment<6>(6 * v));
    T.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  }
  for (std::size_t s = 0; s < next.scales.size(); ++s)
    next.scales[s] += ds(static_cast<Eigen::Index>(s));
  return next;
}

GraphSolver::GraphSolver(const PoseGraph& graph,
                         std::vector<const RelativePose*> edges,
                         int num_threads)
    : system_(std::make_unique<System>(graph, edges, num_threads)) {}
GraphSolver::~GraphSolver() = default;

GraphSolver::Outcome GraphSolver::minimise(const std::vector<WeightedEdge>& edges,
                                           GraphState& state,
                                           int max_iterations,
                                           double relative_tolerance) {
  Outcome outcome;
  double lambda = 1e-8;  // nearly Gauss-Newton: start values are good as a rule
  double growth = 10.0;
  bool fresh = false;
  Eigen::VectorXd dx;
  Eigen::VectorXd ds;
  outcome.chi2 = graph_chi2(system_->graph, edges, state);
  while (outcome.iterations < max_iterations && !outcome.converged && lambda < 1e12) {
    ++outcome.iterations;
    if (!fresh) system_->linearise(edges, state);
    fresh = true;
    double gain = -1.0;
    if (system_->solve(lambda, dx, ds)) {
      const double promised = system_->model_decrease(lambda, dx, ds);
      GraphState next = system_->moved(state, dx, ds);
      const double chi2 = graph_chi2(system_->graph, edges, next);
      gain = promised > 0.0 ? (outcome.chi2 - chi2) / promised : -1.0;
      outcome.converged = promised <= relative_tolerance * outcome.chi2 + 1e-15;
      if (chi2 <= outcome.chi2) {
        outcome.converged |= outcome.chi2 - chi2 <= relative_tolerance * outcome.chi2;
        outcome.chi2 = chi2;
        state = std::move(next);
        fresh = false;
      }
    }
    if (gain > 0.0) {
      lambda = std::max(1e-10, lambda * (gain > 0.75 ? 0.1 : (gain < 0.25 ? 4.0 : 1.0)));
      growth = 10.0;
    } else {
      lambda *= growth;
      growth *= 2.0;
    }
  }
  return outcome;
}

}  // namespace roadbook
