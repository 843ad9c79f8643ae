#include "workflows/find_roads.hpp"

#include <algorithm>

#include "base/format.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "exchange/layers/network_layers.hpp"
#include "exchange/layers/path_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "mapping/pieces.hpp"
#include "mapping/session_car.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/label_store.hpp"
#include "workflows/driven_passes.hpp"
#include "workflows/network_coverage.hpp"
#include "workflows/stored_network.hpp"

namespace roadbook {
namespace {

constexpr double kLeastCoverage = 0.5;  // minimum share of the driven ground that has a lane

PathSummary summary_of(const std::vector<LanePath>& paths) {
  PathSummary worst;
  for (const LanePath& path : paths) {
    worst.deviation_m = std::max(worst.deviation_m, path.deviation_m);
    worst.max_curvature = std::max(worst.max_curvature, path.max_curvature);
    worst.deviating += path.status == LanePathStatus::kDeviates ? 1 : 0;
  }
  return worst;
}

// Carries the friction map to the new paths, so that each knot stays at its place on the ground.
std::optional<FrictionCarry> carry_friction(MapUpdate& update,
                                            const MapLayers& layers,
                                            const Map& map,
                                            const std::vector<LanePath>& paths) {
  auto friction = read_friction_layers(layers, paths);
  if (!friction || (!friction->carry.moved && layers.has("friction"))) return std::nullopt;
  anchor_knots(map, *friction);
  write_friction_layers(update, *friction);
  write_raster_age(update, layers, {"friction_mean", friction->date_ns, kFrictionHalfLife_s},
                   friction->date_ns);
  return friction->carry;
}

}  // namespace

RoadsResult find_roads(const RoadsRequest& request, const Messages& messages) {
  MapUpdate update(request.map);  // locks the map between reading and writing
  const Map map = load_joined_map(request.map);
  const MapLayers layers(request.map);
  const auto previous = stored_network(layers);
  const auto passes = driven_passes(map);
  const RoadNetwork network =
      build_road_network(passes, request.options, previous ? &*previous : nullptr);
  if (network.status == RoadNetworkStatus::kEmpty)
    throw Refused(
        "error: " + request.map.string() + ": driven length: got " +
        fixed(driven_length_m(passes), 2) + " m, want more than lies within a reach of " +
        fixed(network.reach_m, 2) + " m (--reach-m)" +
        (request.options.min_passes > 1
             ? ", driven " + std::to_string(request.options.min_passes) + " times (--min-passes)"
             : ""));
  messages.warn(coverage_warnings(network, request.map.string(), request.options.min_coverage));
  if (!(network.coverage >= kLeastCoverage))
    throw Refused("error: " + request.map.string() + ": coverage: got " +
                  fixed(network.coverage, 4) + ", want at least " + fixed(kLeastCoverage, 2));
  LanePathOptions path_options = request.paths;
  if (const auto width = request.vehicle_width_m ? request.vehicle_width_m : vehicle_width_m(map))
    path_options.vehicle_width_m = *width;
  const auto paths = lane_paths(network, passes, path_options, request.num_threads);
  std::vector<LaneLink> links;
  const auto spaces = layer_of_today(layers, label_layers_of_today(layers), "parking_spaces");
  if (spaces) links = link_spaces(network, read_spaces(request.map, *spaces, network));
  const auto linked = std::count_if(links.begin(), links.end(), [](const LaneLink& link) {
    return link.status == LinkStatus::kLinked;
  });
  write_label_layers(update, layers, map, read_labels(request.map));
  write_network_layers(update, network, source_of(map));
  write_path_layers(update, paths, network, source_of(map));
  if (!links.empty()) write_link_table(update, links);
  const auto carry = carry_friction(update, layers, map, paths);
  const bool stale = !speeds_fit(layers, paths);
  update.note("roads", std::to_string(network.lanes.size()) + " lanes, " +
                           std::to_string(network.intersections.size()) + " intersections");
  update.commit();
  return {network, summary_of(paths), links.size(), static_cast<std::size_t>(linked), carry, stale};
}

}  // namespace roadbook
