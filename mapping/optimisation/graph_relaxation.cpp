#include "mapping/optimisation/graph_relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "mapping/optimisation/pose_graph_components.hpp"
#include "mapping/optimisation/pose_graph_solver.hpp"

namespace roadbook {
namespace {

void check_edges(const PoseGraph& graph,
                 const std::vector<RelativePose>& edges,
                 const std::string& list) {
  const auto n = static_cast<int>(graph.T_map_vehicle.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const RelativePose& e = edges[i];
    const auto fail = [&](const std::string& field, const std::string& got,
                          const std::string& want) {
      throw BadInput(Problem{Severity::kError, "", 0, list + "[" + std::to_string(i) + "]." + field,
                             got, want});
    };
    if (e.from < 0 || e.from >= n) fail("from", std::to_string(e.from), "a pose of the graph");
    if (e.to < 0 || e.to >= n) fail("to", std::to_string(e.to), "a pose of the graph");
    if (e.from == e.to) fail("to", std::to_string(e.to), "another pose than `from`");
    if (e.scale >= static_cast<int>(graph.scales.size()))
      fail("scale", std::to_string(e.scale), "a scale of the graph or -1");
    if (!e.T_from_to.matrix().allFinite() || !e.information.allFinite())
      fail("T_from_to", "not finite", "finite numbers");
    if (!std::isfinite(e.log_scale) || !(e.log_scale_sigma >= 0.0))
      fail("log_scale", "not finite", "a finite number with a standard deviation of at least 0");
  }
}

void check_graph(const PoseGraph& graph) {
  const auto fail = [](const std::string& field, const std::string& got, const std::string& want) {
    throw BadInput(Problem{Severity::kError, "", 0, field, got, want});
  };
  const auto n = static_cast<int>(graph.T_map_vehicle.size());
  if (graph.fixed < 0 || graph.fixed >= n)
    fail("fixed", std::to_string(graph.fixed), "a pose of the graph");
  for (const Eigen::Isometry3d& T : graph.T_map_vehicle)
    if (!T.matrix().allFinite()) fail("T_map_vehicle", "not finite", "finite numbers");
  if (!graph.pose_scales.empty() && graph.pose_scales.size() != graph.T_map_vehicle.size())
    fail("pose_scales", std::to_string(graph.pose_scales.size()) + " scales", "none or one a pose");
  check_edges(graph, graph.odometry, "odometry");
  check_edges(graph, graph.loops, "loops");
}

// One relaxation. `edges` holds the odometry first, then the loops.
struct Relaxation {
  const PoseGraph& graph;
  const PoseGraphOptions& options;
  GraphState state;
  std::vector<WeightedEdge> edges;
  std::vector<std::uint8_t> judged;  // loops that may take part
  std::vector<double> weights;       // of the loops, 0..1
  GraphSolver solver;
  int iterations = 0;
  bool converged = false;

  Relaxation(const PoseGraph& g, const PoseGraphOptions& o)
      : graph(g),
        options(o),
        judged(g.loops.size(), 1),
        weights(g.loops.size(), 1.0),
        solver(g, all_edges(g)) {
    state.poses = g.T_map_vehicle;
    for (const ScaleParameter& scale : g.scales) state.scales.push_back(scale.value);
    for (const PoseScale& scale : g.pose_scales) state.log_scales.push_back(scale.log_scale);
    for (const RelativePose* edge : all_edges(g)) edges.push_back({edge, 1.0});
  }

  static std::vector<const RelativePose*> all_edges(const PoseGraph& g) {
    std::vector<const RelativePose*> all;
    for (const RelativePose& edge : g.odometry) all.push_back(&edge);
    for (const RelativePose& edge : g.loops) all.push_back(&edge);
    return all;
  }
  WeightedEdge& loop_edge(std::size_t k) { return edges[graph.odometry.size() + k]; }

  void minimise(int max_iterations, double tolerance) {
    const auto outcome = solver.minimise(edges, state, max_iterations, tolerance);
    iterations += outcome.iterations;
    converged = outcome.converged;
  }
  std::vector<double> loop_chi2() const {
    std::vector<double> chi2;
    for (const RelativePose& loop : graph.loops) chi2.push_back(edge_chi2(loop, state));
    return chi2;
  }
  void find_false_loops(const Progress& progress);
  void settle();
};

// Weight of the truncated quadratic at control parameter mu (Yang et al. 2020, eq. 14).
double gnc_weight(double chi2, double c2, double mu) {
  if (chi2 <= mu / (mu + 1.0) * c2) return 1.0;
  if (chi2 >= (mu + 1.0) / mu * c2) return 0.0;
  return std::sqrt(c2 * mu * (mu + 1.0) / chi2) - mu;
}

void Relaxation::find_false_loops(const Progress& progress) {
  const std::vector<int> crowding = loop_crowding(graph.loops, options.cluster_span);
  const double c2 = options.max_loop_chi2;
  std::vector<double> chi2 = loop_chi2();
  double worst = 0.0;
  for (std::size_t k = 0; k < chi2.size(); ++k)
    if (judged[k] != 0) worst = std::max(worst, chi2[k]);
  if (2.0 * worst <= c2) return;
  double mu = c2 / (2.0 * worst - c2);
  constexpr int kMostSteps = 200;
  constexpr double kStepTolerance = 1e-2;  // weights change at every step: no need for the optimum
  // Scales bend the whole way behind them: linearised steps are shorter.
  const int more_iterations = graph.pose_scales.empty() ? 0 : 4;
  for (int step = 0; step < kMostSteps; ++step) {
    report(progress, "pose graph", static_cast<std::size_t>(step), 0);
    bool decided = true;
    for (std::size_t k = 0; k < chi2.size(); ++k) {
      weights[k] = judged[k] != 0 ? gnc_weight(chi2[k], c2, mu) : 0.0;
      decided &= weights[k] <= 0.0 || weights[k] >= 1.0;
      loop_edge(k).weight = weights[k] / crowding[k];
    }
    if (decided && mu > 1.0) break;
    minimise((decided ? 3 : 2) + more_iterations, kStepTolerance);
    chi2 = loop_chi2();
    mu *= options.gnc_factor;
  }
}

// Gives accepted loops their full information. While loops shared votes, odometry had more weight,
// and some true loops lay just beyond the gate. The first round therefore accepts loops up to a
// wider gate; later rounds reject those that still do not fit.
void Relaxation::settle() {
  constexpr double kTried = 4.0;  // times the gate: twice its distance
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> chi2 = loop_chi2();
    const double gate = (round == 0 ? kTried : 1.0) * options.max_loop_chi2;
    bool changed = round == 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double before = weights[k];
      if (options.robust) weights[k] = judged[k] != 0 && chi2[k] <= gate ? 1.0 : 0.0;
      changed |= before != weights[k];
      loop_edge(k).weight = weights[k];
    }
    if (!changed) return;
    minimise(options.max_iterations, options.relative_tolerance);
  }
}

void fill_result(Relaxation& run, const GraphState& start, PoseGraphResult& result) {
  result.initial_chi2 = graph_chi2(run.graph, run.edges, start);
  result.final_chi2 = graph_chi2(run.graph, run.edges, run.state);
  result.T_map_vehicle = run.state.poses;
  result.scales = run.state.scales;
  result.log_scales = run.state.log_scales;
  result.loop_weights = run.weights;
  result.loop_chi2 = run.loop_chi2();
  result.iterations = run.iterations;
  for (std::size_t k = 0; k < run.weights.size(); ++k)
    result.loop_accepted.push_back(run.loop_edge(k).weight > 0.0);
  result.component = connected_components(run.graph, result.loop_accepted);
  result.components = 1 + *std::max_element(result.component.begin(), result.component.end());
  const bool finite = std::all_of(result.T_map_vehicle.begin(), result.T_map_vehicle.end(),
                                  [](const auto& T) { return T.matrix().allFinite(); });
  result.usable = finite && run.converged;
  result.message =
      !finite ? "not finite" : (run.converged ? "converged" : "stopped after max_iterations");
}

}  // namespace

PoseGraphResult relax(const PoseGraph& graph,
                      const PoseGraphOptions& options,
                      const Progress& progress) {
  options.check();
  PoseGraphResult result;
  if (graph.T_map_vehicle.empty()) {
    result.components = 0;
    result.message = "no poses";
    return result;
  }
  check_graph(graph);
  Relaxation run(graph, options);
  if (options.join_components) run.judged = join_components(graph, options, run.state.poses);
  for (std::size_t k = 0; k < run.judged.size(); ++k)
    if (run.judged[k] == 0) run.weights[k] = 0.0;
  const GraphState start = run.state;
  if (options.robust && !graph.loops.empty()) run.find_false_loops(progress);
  run.settle();
  fill_result(run, start, result);
  return result;
}

}  // namespace roadbook
