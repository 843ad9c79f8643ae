#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "exchange/layers/network_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "roadnet/build_network.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/roadnet/rounded_roads.hpp"

namespace roadbook::test {

/// A place with all cases that exports must distinguish, on a slope: a two-way ring with rounded
/// corners, a two-way aisle across it, and a one-way dead end.
struct DrivenPlace {
  std::vector<DrivenPass> passes;
  RoadNetwork network;
  std::vector<LanePath> paths;

  DrivenPlace() {
    const RoundedRectangle road{70.0, 50.0, 5.5};
    for (DrivenPass& pass : drive_round(road, 3, 0.1, 4)) {
      DrivenPass back = pass;
      std::reverse(back.positions.begin(), back.positions.end());
      passes.push_back(std::move(pass));
      passes.push_back(std::move(back));
    }
    Random random(4, "aisle");
    for (int lap = 0; lap < 2; ++lap) {
      DrivenPass aisle;
      const double x = 35.0 + random.normal(0.0, 0.1);
      for (double y = 0.0; y <= 50.0; y += 0.2) aisle.positions.emplace_back(x, y, 0.0);
      if (lap == 1) std::reverse(aisle.positions.begin(), aisle.positions.end());
      passes.push_back(std::move(aisle));
    }
    DrivenPass end;
    for (double d = 0.0; d <= 25.0; d += 0.2) end.positions.emplace_back(70.0 + d, 25.0, 0.0);
    passes.push_back(end);
    for (DrivenPass& pass : passes)
      for (auto& p : pass.positions) p.z() = 0.02 * p.x();
    network = build_road_network(passes);
    paths = lane_paths(network, passes);
  }
};

/// A small map with the network and the paths of that place; `extra` goes to `map_meta`.
inline std::filesystem::path make_map_with_paths(const Folder& folder,
                                                 const std::map<std::string, std::string>& extra) {
  const auto path = folder / "place.gpkg";
  const DrivenPlace place;
  MapFileBuilder(path, "key").finish(small_map(1), extra);
  MapUpdate update(path);
  const NetworkSource source{"drive 0,drive 1", "2014-06-24T18:02:59.763Z", 0.02};
  write_network_layers(update, place.network, source);
  write_path_layers(update, place.paths, place.network, source);
  update.commit();
  return path;
}

/// Copies a map file to `place.gpkg` in `folder`.
inline std::filesystem::path copy_of_map(const std::filesystem::path& map, const Folder& folder) {
  auto copy = folder / "place.gpkg";
  std::filesystem::copy_file(map, copy, std::filesystem::copy_options::overwrite_existing);
  return copy;
}

/// The same, as a copy: without `extra`, the map is made once for all tests of a program.
inline std::filesystem::path map_with_paths(const Folder& folder,
                                            const std::map<std::string, std::string>& extra = {}) {
  if (!extra.empty()) return make_map_with_paths(folder, extra);
  static const Folder once;
  static const std::filesystem::path made = make_map_with_paths(once, {});
  return copy_of_map(made, folder);
}

}  // namespace roadbook::test
