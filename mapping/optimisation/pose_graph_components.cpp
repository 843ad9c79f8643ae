#include "mapping/optimisation/pose_graph_components.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "base/index.hpp"
#include "mapping/union_find.hpp"

namespace roadbook {
namespace {

/// A placement of a component: `C` moves its poses, `votes` loops agree with it.
struct Placement {
  int component = -1;
  int votes = 0;
  Eigen::Isometry3d C = Eigen::Isometry3d::Identity();
};

bool loops_agree(const Eigen::Isometry3d& a,
                 const Eigen::Isometry3d& b,
                 const Eigen::Isometry3d& there,
                 const PoseGraphOptions& options) {
  // Compared at the end of the loop: at the map's origin a small rotation would move points far.
  const Eigen::Isometry3d difference = (a * there).inverse() * (b * there);
  return difference.translation().norm() <= options.join_tolerance_m &&
         so3_log(difference.linear()).norm() <= options.join_tolerance_rad;
}

// Each loop to a joined component proposes a placement; the one with most votes is returned.
Placement best_placement(const PoseGraph& graph,
                         const PoseGraphOptions& options,
                         const std::vector<int>& component_of,
                         const std::vector<std::uint8_t>& joined,
                         const std::vector<Eigen::Isometry3d>& poses,
                         int component) {
  struct Vote {
    Eigen::Isometry3d C;
    Eigen::Isometry3d end;
  };
  std::vector<Vote> votes;
  for (const RelativePose& loop : graph.loops) {
    const int a = component_of[at(loop.from)];
    const int b = component_of[at(loop.to)];
    const Eigen::Isometry3d& from = poses[at(loop.from)];
    const Eigen::Isometry3d& to = poses[at(loop.to)];
    if (joined[at(a)] != 0 && b == component)
      votes.push_back({from * loop.T_from_to * to.inverse(), to});
    else if (joined[at(b)] != 0 && a == component)
      votes.push_back({to * loop.T_from_to.inverse() * from.inverse(), from});
  }
  Placement best{component, 0, Eigen::Isometry3d::Identity()};
  constexpr std::size_t kMostCandidates = 400;  // evenly among them: the work stays linear
  const std::size_t stride = votes.size() / kMostCandidates + 1;
  for (std::size_t i = 0; i < votes.size(); i += stride) {
    const auto agreeing =
        static_cast<int>(std::count_if(votes.begin(), votes.end(), [&](const Vote& other) {
          return loops_agree(votes[i].C, other.C, other.end, options);
        }));
    if (agreeing > best.votes) best = {component, agreeing, votes[i].C};
  }
  return best;
}

}  // namespace

std::vector<int> connected_components(const PoseGraph& graph,
                                      const std::vector<std::uint8_t>& use) {
  UnionFind sets(graph.T_map_vehicle.size());
  for (const RelativePose& edge : graph.odometry) sets.join(edge.from, edge.to);
  for (std::size_t k = 0; k < graph.loops.size(); ++k)
    if (use[k] != 0) sets.join(graph.loops[k].from, graph.loops[k].to);
  return sets.numbers();
}

std::vector<std::uint8_t> join_components(const PoseGraph& graph,
                                          const PoseGraphOptions& options,
                                          std::vector<Eigen::Isometry3d>& T_map_vehicle) {
  const std::vector<int> component_of =
      connected_components(graph, std::vector<std::uint8_t>(graph.loops.size(), 0));
  const int components = 1 + *std::max_element(component_of.begin(), component_of.end());
  std::vector<std::uint8_t> joined(at(components), 0);
  joined[at(component_of[at(graph.fixed)])] = 1;
  for (int count = 1; count < components; ++count) {
    Placement best;
    for (int component = 0; component < components; ++component) {
      if (joined[at(component)] != 0) continue;
      const Placement placement =
          best_placement(graph, options, component_of, joined, T_map_vehicle, component);
      if (placement.votes > best.votes) best = placement;
    }
    if (best.votes < options.min_join_loops) break;
    for (std::size_t i = 0; i < T_map_vehicle.size(); ++i)
      if (component_of[i] == best.component) T_map_vehicle[i] = best.C * T_map_vehicle[i];
    joined[at(best.component)] = 1;
  }
  std::vector<std::uint8_t> judged(graph.loops.size());
  for (std::size_t k = 0; k < judged.size(); ++k) {
    const int a = component_of[at(graph.loops[k].from)];
    const int b = component_of[at(graph.loops[k].to)];
    judged[k] = a == b || (joined[at(a)] != 0 && joined[at(b)] != 0);
  }
  return judged;
}

std::vector<int> loop_crowding(const std::vector<RelativePose>& loops, int span) {
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto low = [&](std::size_t k) { return std::min(loops[k].from, loops[k].to); };
  const auto high = [&](std::size_t k) { return std::max(loops[k].from, loops[k].to); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return low(a) != low(b) ? low(a) < low(b) : a < b;
  });
  std::vector<int> crowding(loops.size(), 1);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && low(order[j]) - low(order[i]) <= span; ++j) {
      if (std::abs(high(order[j]) - high(order[i])) > span) continue;
      ++crowding[order[i]];
      ++crowding[order[j]];
    }
  return crowding;
}

}  // namespace roadbook
