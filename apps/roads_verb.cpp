#include <memory>
#include <nlohmann/json.hpp>

#include "apps/driven_passes.hpp"
#include "apps/format.hpp"
#include "apps/stored_network.hpp"
#include "apps/verb.hpp"
#include "mapping/map_file.hpp"
#include "roadnet/build_network.hpp"

namespace roadbook {
namespace {

struct RoadsCommand {
  std::filesystem::path map;
  RoadNetworkOptions options;
};

ExitStatus run(const RoadsCommand& command, Console& console) {
  const Map map = load_map(command.map);
  const auto previous = stored_network(MapLayers(command.map));
  const RoadNetwork network =
      build_road_network(driven_passes(map), command.options, previous ? &*previous : nullptr);
  if (network.status == RoadNetworkStatus::kEmpty)
    throw Refused("error: " + command.map.string() + ": driven length: got none, want some");
  if (network.status != RoadNetworkStatus::kOk)
    throw Refused("error: " + command.map.string() + ": coverage: got " +
                  fixed(network.coverage, 4) + ", want at least " +
                  fixed(command.options.min_coverage, 4));
  MapUpdate update(command.map);
  write_network_layers(update, network, source_of(map));
  update.commit();
  console.say(std::to_string(network.lanes.size()) + " lanes, " +
              std::to_string(network.intersections.size()) + " intersections, " +
              fixed(network.length_m, 1) + " m; " + fixed(100.0 * network.coverage, 1) +
              " % of the driven positions within " + fixed(network.reach_m, 2) + " m");
  console.result({{"lanes", network.lanes.size()},
                  {"intersections", network.intersections.size()},
                  {"length_m", network.length_m},
                  {"coverage", network.coverage},
                  {"reach_m", network.reach_m},
                  {"cycle_rank", network.cycle_rank},
                  {"components", network.components}});
  return ExitStatus::kDone;
}

}  // namespace

Verb roads_verb() {
  auto command = std::make_shared<RoadsCommand>();
  return {"roads", "finds lanes and intersections of a map",
          [command](Options& options) {
            RoadNetworkOptions& o = command->options;
            options.add("--map,-m", &command->map, "map file").required = true;
            options.add("--reach-m", &o.reach_m, "cover radius [m]; 0: from the data").range = {
                0.0, 100.0};
            options
                .add("--min-passes", &o.min_passes, "places where fewer passes go by are left out")
                .range = {1, 1000};
          },
          [command](Console& console, const CommonOptions&) { return run(*command, console); }};
}

}  // namespace roadbook
