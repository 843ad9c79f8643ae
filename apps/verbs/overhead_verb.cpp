#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/session_drives.hpp"
#include "apps/summary_json.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "base/error.hpp"
#include "base/format.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/overhead/overhead.hpp"
#include "semantics/overhead/overhead_layers.hpp"

namespace roadbook {
namespace {

struct OverheadCommand {
  std::filesystem::path map;
  std::filesystem::path output;
  std::vector<std::filesystem::path> drives;
  std::string mode = "weighted";
  std::filesystem::path vehicle;
  bool keep_exposure = false;
  OverheadOptions options;
};

// Share of each camera's image that the own vehicle takes, by session.
nlohmann::ordered_json masked_json(const Map& map, const OverheadSummary& made) {
  nlohmann::ordered_json sessions = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < made.vehicles.size(); ++s) {
    nlohmann::ordered_json cameras = nlohmann::ordered_json::object();
    const auto& share = made.vehicles[s].masked_share;
    for (std::size_t c = 0; c < share.size(); ++c)
      cameras[map.sessions[s].rig.cameras[c].name] = share[c];
    sessions.push_back(std::move(cameras));
  }
  return sessions;
}

std::string exposure_line(const OverheadExposure& exposure) {
  const auto percent = [](double share) { return fixed(100.0 * share, 1) + " %"; };
  if (!exposure.balanced)
    return "exposure as recorded: " + percent(exposure.saturated_recorded) +
           " of the ground saturated";
  return "exposure balanced by gains of " + fixed(exposure.least_gain, 2) + " to " +
         fixed(exposure.most_gain, 2) + ": " + percent(exposure.saturated) +
         " of the ground saturated, " + percent(exposure.saturated_recorded) + " without";
}

ExitStatus run_overhead(const OverheadCommand& command,
                        Console& console,
                        const CommonOptions& common) {
  OverheadOptions options = command.options;
  options.num_threads = common.threads;
  options.mode = command.mode == "mean" ? OverheadMode::kMean : OverheadMode::kWeighted;
  options.balance_exposure = !command.keep_exposure;
  options.vehicle = given_vehicle(command.vehicle);
  const Map map = load_map(command.map);
  const auto drives = open_session_drives(command.map, map, command.drives, console);
  std::vector<const Drive*> pointers;
  for (const auto& drive : drives) pointers.push_back(drive ? &*drive : nullptr);
  if (std::all_of(pointers.begin(), pointers.end(), [](const Drive* d) { return d == nullptr; }))
    throw BadInput({Severity::kError, command.map.string(), 0, "drives",
                    "none of " + std::to_string(pointers.size()),
                    "at least one recorded drive (--drive FOLDER)"});
  const std::filesystem::path folder =
      command.output.empty() ? std::filesystem::path(command.map).replace_extension() += "_overhead"
                             : command.output;
  const OverheadSummary made = make_overhead(map, pointers, folder, options, console.progress());
  MapUpdate update(command.map);
  store_overhead(map, made, &update);
  update.commit();
  console.warn(made.warnings);
  console.say(std::to_string(made.columns) + " x " + std::to_string(made.rows) + " pixels of " +
              fixed(made.resolution_m, 3) + " m, " + fixed(made.covered_m2, 0) + " m^2 seen, " +
              std::to_string(made.images_used) + " images");
  std::vector<VehicleSource> sources;
  for (std::size_t s = 0; s < made.vehicles.size(); ++s)
    if (drives[s]) sources.push_back(made.vehicles[s].source);
  say_vehicle(console, sources);
  console.say(exposure_line(made.exposure));
  console.say("overhead image: layer overhead of " + command.map.string() + "; " +
              made.image.string());
  console.result({{"columns", made.columns},
                  {"rows", made.rows},
                  {"resolution_m", made.resolution_m},
                  {"west_m", made.west_m},
                  {"north_m", made.north_m},
                  {"covered_m2", made.covered_m2},
                  {"coverage", made.coverage},
                  {"sigma_grey", made.sigma_grey},
                  {"exposure",
                   {{"balanced", made.exposure.balanced},
                    {"least_gain", made.exposure.least_gain},
                    {"most_gain", made.exposure.most_gain},
                    {"saturated", made.exposure.saturated},
                    {"saturated_recorded", made.exposure.saturated_recorded}}},
                  {"warnings", to_json(made.warnings)},
                  {"views", made.views},
                  {"images_used", made.images_used},
                  {"images_missing", made.images_missing},
                  {"max_range_m", made.max_range_m},
                  {"vehicle", vehicle_json(sources)},
                  {"masked_share", masked_json(map, made)},
                  {"image", made.image.string()},
                  {"count", made.count.string()},
                  {"variance", made.variance.string()},
                  {"frames", made.frames.string()}});
  return ExitStatus::kDone;
}

}  // namespace

Verb overhead_verb() {
  auto command = std::make_shared<OverheadCommand>();
  return {
      "overhead", "makes the overhead image of a map",
      [command](Options& options) {
        OverheadOptions& o = command->options;
        options.add("--map,-m", &command->map, "map file").required = true;
        options.add("--output,-o", &command->output,
                    "folder of the GeoTIFFs; default: MAP without extension, _overhead");
        add_drive_option(options, &command->drives);
        options.add("--resolution-m", &o.resolution_m, "side of a pixel [m]").range = {0.002, 1.0};
        options
            .add("--max-range-m", &o.max_range_m,
                 "farthest ground taken from a camera [m]; default: 8, more for cameras that see "
                 "no ground so near")
            .range = {0.5, 100.0};
        add_vehicle_option(options, &command->vehicle);
        options.add("--mode", &command->mode, "how images are averaged").choices = {"weighted",
                                                                                    "mean"};
        options.add("--keep-exposure", &command->keep_exposure, "do not balance exposure");
        options.add("--memory-mb", &o.memory_mb, "for tiles in work").range = {64, 1e6};
      },
      [command](Console& console, const CommonOptions& common) {
        return run_overhead(*command, console, common);
      }};
}

}  // namespace roadbook
