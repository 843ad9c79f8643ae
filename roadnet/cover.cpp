#include "roadnet/cover.hpp"

#include "roadnet/spatial_hash.hpp"

namespace roadbook {

RoadGraph cover_graph(const std::vector<PassSamples>& passes, double reach_m) {
  RoadGraph graph;
  SpatialHash kept(reach_m);
  for (const PassSamples& pass : passes) {
    for (const Eigen::Vector3d& point : pass.points) {
      if (kept.nearest(point, reach_m) >= 0) continue;
      kept.insert(point);
      graph.add_node(point);
    }
  }
  // Only now, with all places known, is each sample given to its nearest: given to the first
  // within reach, a pass would change sides between two lanes that run close together.
  for (const PassSamples& pass : passes) {
    int last = -1;
    for (const Eigen::Vector3d& point : pass.points) {
      const int node = kept.nearest(point, reach_m);
      if (last >= 0) graph.add_edge(last, node);
      last = node;
    }
  }
  return graph;
}

}  // namespace roadbook
