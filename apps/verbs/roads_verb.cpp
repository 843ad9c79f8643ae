#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/verb.hpp"
#include "base/format.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "mapping/session_car.hpp"
#include "mapping/store/map_file.hpp"
#include "roadnet/build_network.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/driven_passes.hpp"
#include "workflows/network_coverage.hpp"
#include "workflows/stored_network.hpp"

namespace roadbook {
namespace {

constexpr double kLeastCoverage = 0.5;  // a network with less of what was driven serves nobody

struct RoadsCommand {
  std::filesystem::path map;
  RoadNetworkOptions options;
  LanePathOptions paths;
  std::optional<double> vehicle_width_m;
};

// What the paths of the lanes are like, at their worst.
struct PathSummary {
  double deviation_m = 0.0;
  double max_curvature = 0.0;
  int deviating = 0;
};

PathSummary summary_of(const std::vector<LanePath>& paths) {
  PathSummary worst;
  for (const LanePath& path : paths) {
    worst.deviation_m = std::max(worst.deviation_m, path.deviation_m);
    worst.max_curvature = std::max(worst.max_curvature, path.max_curvature);
    worst.deviating += path.status == LanePathStatus::kDeviates ? 1 : 0;
  }
  return worst;
}

// The friction map goes with the paths: every knot stays on its ground.
std::optional<FrictionCarry> carry_friction(MapUpdate& update,
                                            const MapLayers& layers,
                                            const Map& map,
                                            const std::vector<LanePath>& paths) {
  auto friction = read_friction_layers(layers, paths);
  if (!friction || (!friction->carry.moved && layers.has("friction"))) return std::nullopt;
  anchor_knots(map, *friction);
  write_friction_layers(update, *friction);
  return friction->carry;
}

void say_carry(const Console& console, const FrictionCarry& carry) {
  const double all = carry.evidence + carry.evidence_dropped;
  console.say("friction map carried over to these paths: " +
              fixed(all > 0.0 ? 100.0 * carry.evidence / all : 100.0, 2) +
              " % of its labels kept, " + std::to_string(carry.dropped) +
              " knots lie on no path any more");
}

ExitStatus run_roads(const RoadsCommand& command, Console& console, int threads) {
  MapUpdate update(command.map);  // nobody changes the map between reading and writing
  const Map map = load_map(command.map);
  const MapLayers layers(command.map);
  const auto previous = stored_network(layers);
  const auto passes = driven_passes(map);
  const RoadNetwork network =
      build_road_network(passes, command.options, previous ? &*previous : nullptr);
  if (network.status == RoadNetworkStatus::kEmpty)
    throw Refused(
        "error: " + command.map.string() + ": driven length: got " +
        fixed(driven_length_m(passes), 2) + " m, want more than lies within a reach of " +
        fixed(network.reach_m, 2) + " m (--reach-m)" +
        (command.options.min_passes > 1
             ? ", driven " + std::to_string(command.options.min_passes) + " times (--min-passes)"
             : ""));
  console.warn(coverage_warnings(network, command.map.string(), command.options.min_coverage));
  if (!(network.coverage >= kLeastCoverage))
    throw Refused("error: " + command.map.string() + ": coverage: got " +
                  fixed(network.coverage, 4) + ", want at least " + fixed(kLeastCoverage, 2));
  LanePathOptions path_options = command.paths;
  if (const auto width = command.vehicle_width_m ? command.vehicle_width_m : vehicle_width_m(map))
    path_options.vehicle_width_m = *width;
  const auto paths = lane_paths(network, passes, path_options, threads);
  const PathSummary worst = summary_of(paths);
  std::vector<LaneLink> links;
  const auto spaces = layer_of_today(layers, label_layers_of_today(layers), "parking_spaces");
  if (spaces) links = link_spaces(network, read_spaces(command.map, *spaces, network));
  const auto linked = std::count_if(links.begin(), links.end(), [](const LaneLink& link) {
    return link.status == LinkStatus::kLinked;
  });
  write_label_layers(update, layers, map, read_labels(command.map));
  write_network_layers(update, network, source_of(map));
  write_path_layers(update, paths, network, source_of(map));
  if (!links.empty()) write_link_table(update, links);
  const auto carry = carry_friction(update, layers, map, paths);
  const bool stale_speeds = !speeds_fit(layers, paths);
  update.commit();
  console.say(std::to_string(network.lanes.size()) + " lanes, " +
              std::to_string(network.intersections.size()) + " intersections, " +
              fixed(network.length_m, 1) + " m; " + fixed(100.0 * network.coverage, 1) +
              " % of the driven positions within " + fixed(network.reach_m, 2) + " m");
  console.say("paths: at most " + fixed(worst.deviation_m, 3) + " m from what was driven, " +
              "tightest bend " + fixed(worst.max_curvature, 3) + " 1/m; " +
              std::to_string(worst.deviating) + " farther off than " +
              fixed(command.paths.max_deviation_m, 2) + " m");
  if (!links.empty())
    console.say(std::to_string(linked) + " of " + std::to_string(links.size()) +
                " parking spaces have a lane before them");
  if (carry) say_carry(console, *carry);
  if (stale_speeds)
    console.note("the speed map was made on other paths: run `roadbook speeds` again");
  console.result({{"lanes", network.lanes.size()},
                  {"intersections", network.intersections.size()},
                  {"length_m", network.length_m},
                  {"coverage", network.coverage},
                  {"uncovered", uncovered_json(network)},
                  {"reach_m", network.reach_m},
                  {"cycle_rank", network.cycle_rank},
                  {"components", network.components},
                  {"paths",
                   {{"deviation_m", worst.deviation_m},
                    {"max_curvature", worst.max_curvature},
                    {"deviating", worst.deviating}}},
                  {"spaces", {{"linked", linked}, {"total", links.size()}}},
                  {"friction_carried", carry.has_value()},
                  {"friction_evidence_kept", carry ? carry->evidence : 0.0},
                  {"friction_evidence_dropped", carry ? carry->evidence_dropped : 0.0},
                  {"speeds_stale", stale_speeds}});
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
            options
                .add("--vehicle-width-m", &command->vehicle_width_m,
                     "of the recording vehicle, for the width of the lanes; default: as the map "
                     "knows it, else 1.9")
                .range = {0.1, 10.0};
          },
          [command](Console& console, const CommonOptions& common) {
            return run_roads(*command, console, common.threads);
          }};
}

}  // namespace roadbook
