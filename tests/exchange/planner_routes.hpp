#pragma once

#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "roadnet/routing/lane_layout.hpp"
#include "tests/exchange/driven_place.hpp"

namespace roadbook::test {

/// A piece of the layout and whether it is driven along its curve.
using DrivenLane = std::pair<int, bool>;

/// Returns the lanes that a vehicle can reach from `from` over the turns of the layout. For a ring,
/// the set contains only `from`.
inline std::set<DrivenLane> reachable_lanes(const LaneLayout& layout, const DrivenLane& from) {
  std::set<DrivenLane> reached;
  std::vector<DrivenLane> todo{from};
  const auto add = [&](const DrivenLane& lane) {
    if (reached.insert(lane).second) todo.push_back(lane);
  };
  while (!todo.empty()) {
    const DrivenLane lane = todo.back();
    todo.pop_back();
    for (const Connector& turn : layout.connectors) {
      // A lane driven along its curve leaves at its end and is entered at its begin.
      if (turn.from.piece == lane.first && turn.from.at_end == lane.second)
        add({turn.to.piece, !turn.to.at_end});
      if (turn.both_ways && turn.to.piece == lane.first && turn.to.at_end == lane.second)
        add({turn.from.piece, !turn.from.at_end});
    }
  }
  return reached;
}

/// A small map with the roads of some passes; their paths go to `paths`.
inline std::filesystem::path map_of_passes(const Folder& folder,
                                           const std::vector<DrivenPass>& passes,
                                           std::vector<LanePath>* paths_found = nullptr) {
  const auto path = folder / "roads.gpkg";
  const RoadNetwork network = build_road_network(passes);
  const auto paths = lane_paths(network, passes);
  MapFileBuilder(path, "key").finish(small_map(1), {});
  MapUpdate update(path);
  const NetworkSource source{"drive 0", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, network, source);
  write_path_layers(update, paths, network, source);
  update.commit();
  if (paths_found != nullptr) *paths_found = paths;
  return path;
}

}  // namespace roadbook::test
