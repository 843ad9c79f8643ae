#include "roadnet/lane_centre.hpp"

#include <algorithm>
#include <cmath>

#include "roadnet/spatial_hash.hpp"

namespace roadbook {
namespace {

constexpr int kCentreRounds = 12;
constexpr int kKeptRounds =
    4;  // the points move little: samples are given to them anew only so often
constexpr double kPull = 0.5;    // share of the way to the middle of the samples, each round
constexpr double kSmooth = 0.2;  // share of the way to the middle of the neighbours

struct Pull {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
};

std::vector<Eigen::Vector3d> divide(const std::vector<Eigen::Vector3d>& line, double step_m) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  const int pieces = std::max(5, static_cast<int>(std::ceil(length / step_m)));
  std::vector<Eigen::Vector3d> inner;
  double done = 0.0;
  std::size_t segment = 0;
  for (int k = 1; k < pieces; ++k) {
    const double target = length * k / pieces;
    double piece = (line[segment + 1] - line[segment]).norm();
    while (done + piece < target && segment + 2 < line.size()) {
      done += piece;
      ++segment;
      piece = (line[segment + 1] - line[segment]).norm();
    }
    const double share = piece > 0.0 ? (target - done) / piece : 0.0;
    inner.push_back(line[segment] + share * (line[segment + 1] - line[segment]));
  }
  return inner;
}

// Direction of the line through a point of degree 2, or out of its end.
Eigen::Vector3d tangent(const RoadGraph& graph, std::size_t i) {
  const auto& list = graph.neighbours[i];
  const Eigen::Vector3d& a = graph.positions[static_cast<std::size_t>(list.front())];
  const Eigen::Vector3d& b =
      list.size() == 1 ? graph.positions[i] : graph.positions[static_cast<std::size_t>(list[1])];
  return (b - a).stableNormalized();
}

std::vector<Pull> gather(const RoadGraph& graph,
                         const std::vector<PassSamples>& passes,
                         double reach_m) {
  SpatialHash hash(1.5 * reach_m);
  for (const Eigen::Vector3d& position : graph.positions) hash.insert(position);
  std::vector<Pull> pulls(graph.positions.size());
  for (const PassSamples& pass : passes) {
    for (const Eigen::Vector3d& point : pass.points) {
      const int at = hash.nearest(point, 1.5 * reach_m);
      if (at < 0) continue;
      Pull& pull = pulls[static_cast<std::size_t>(at)];
      pull.sum += point;
      ++pull.count;
    }
  }
  return pulls;
}

void move_points(RoadGraph& graph, const std::vector<Pull>& pulls) {
  const std::vector<Eigen::Vector3d> before = graph.positions;
  RoadGraph& moved = graph;
  std::vector<Eigen::Vector3d> after = before;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto& list = moved.neighbours[i];
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int other : list) middle += before[static_cast<std::size_t>(other)];
    middle /= static_cast<double>(list.size());
    if (pulls[i].count > 0) {
      Eigen::Vector3d offset = pulls[i].sum / pulls[i].count - before[i];
      // Along the line the samples say nothing; at an intersection every direction counts.
      if (list.size() <= 2) offset -= offset.dot(tangent(moved, i)) * tangent(moved, i);
      after[i] += kPull * offset;
    }
    if (list.size() > 1) after[i] += kSmooth * (middle - before[i]);
  }
  graph.positions = after;
}

void lengthen_dead_ends(RoadGraph& graph, const std::vector<PassSamples>& passes, double reach_m) {
  SpatialHash hash(2.0 * reach_m);
  std::vector<std::size_t> tips;
  for (std::size_t i = 0; i < graph.positions.size(); ++i) {
    if (graph.neighbours[i].size() != 1) continue;
    tips.push_back(i);
    hash.insert(graph.positions[i]);
  }
  std::vector<double> beyond(tips.size(), 0.0);
  for (const PassSamples& pass : passes) {
    for (const Eigen::Vector3d& point : pass.points) {
      hash.visit_near(point, 2.0 * reach_m, [&](int index, double) {
        const std::size_t tip = tips[static_cast<std::size_t>(index)];
        const Eigen::Vector3d d = point - graph.positions[tip];
        const double along = d.dot(tangent(graph, tip));
        const double across = (d - along * tangent(graph, tip)).norm();
        double& farthest = beyond[static_cast<std::size_t>(index)];
        if (across < 0.5 * reach_m) farthest = std::max(farthest, along);
      });
    }
  }
  for (std::size_t k = 0; k < tips.size(); ++k) {
    graph.positions[tips[k]] += beyond[k] * tangent(graph, tips[k]);
  }
}

}  // namespace

LaneCurves densify(const RoadGraph& skeleton, const std::vector<LaneChain>& lanes, double step_m) {
  LaneCurves curves;
  std::vector<int> place(skeleton.positions.size(), -1);
  const auto shared = [&](int node) {
    int& at = place[static_cast<std::size_t>(node)];
    if (at < 0) at = curves.points.add_node(skeleton.positions[static_cast<std::size_t>(node)]);
    return at;
  };
  for (const LaneChain& lane : lanes) {
    std::vector<Eigen::Vector3d> line;
    for (const int node : lane.nodes) {
      line.push_back(skeleton.positions[static_cast<std::size_t>(node)]);
    }
    LaneChain dense{{shared(lane.nodes.front())}, lane.closed};
    for (const Eigen::Vector3d& point : divide(line, step_m)) {
      dense.nodes.push_back(curves.points.add_node(point));
    }
    dense.nodes.push_back(shared(lane.nodes.back()));
    for (std::size_t i = 0; i + 1 < dense.nodes.size(); ++i) {
      curves.points.add_edge(dense.nodes[i], dense.nodes[i + 1]);
    }
    curves.lanes.push_back(std::move(dense));
  }
  return curves;
}

void fit_centres(LaneCurves& curves, const std::vector<PassSamples>& passes, double reach_m) {
  std::vector<Pull> pulls;
  for (int round = 0; round < kCentreRounds; ++round) {
    if (round % kKeptRounds == 0) pulls = gather(curves.points, passes, reach_m);
    move_points(curves.points, pulls);
  }
  lengthen_dead_ends(curves.points, passes, reach_m);
}

}  // namespace roadbook
