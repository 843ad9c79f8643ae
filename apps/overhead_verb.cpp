#include <memory>
#include <nlohmann/json.hpp>

#include "apps/format.hpp"
#include "apps/session_drives.hpp"
#include "apps/verb.hpp"
#include "mapping/map_file.hpp"
#include "semantics/overhead.hpp"

namespace roadbook {
namespace {

struct OverheadCommand {
  std::filesystem::path map;
  std::filesystem::path output;
  std::string mode = "weighted";
  bool keep_exposure = false;
  OverheadOptions options;
};

// The drives of all sessions; empty where one is not at hand, which is said.
std::vector<std::optional<Drive>> open_drives(const std::filesystem::path& map_file,
                                              const Map& map,
                                              const Console& console) {
  std::vector<std::optional<Drive>> drives;
  for (const Session& session : map.sessions) {
    const auto folder = session_folder(map_file, session);
    drives.emplace_back();
    if (std::filesystem::is_directory(folder)) {
      drives.back() = Drive::open(folder);
    } else {
      console.warn({{Severity::kWarning, folder.string(), 0, "drive of session " + session.name,
                     "no such folder", "the recorded drive; the session is left out"}});
    }
  }
  return drives;
}

void store(const std::filesystem::path& map, const OverheadSummary& made) {
  MapUpdate update(map);
  update.write_raster("overhead", made.image, {.description = "ground seen from above, grey"});
  update.write_raster("overhead_count", made.count, {.description = "images per pixel"});
  update.write_raster("overhead_variance", made.variance, {.description = "variance of grey"});
  update.note("overhead", std::to_string(made.views) + " keyframes");
  update.commit();
}

ExitStatus run(const OverheadCommand& command, Console& console, const CommonOptions& common) {
  OverheadOptions options = command.options;
  options.num_threads = common.threads;
  options.mode = command.mode == "mean" ? OverheadMode::kMean : OverheadMode::kWeighted;
  options.balance_exposure = !command.keep_exposure;
  const Map map = load_map(command.map);
  const auto drives = open_drives(command.map, map, console);
  std::vector<const Drive*> pointers;
  for (const auto& drive : drives) pointers.push_back(drive ? &*drive : nullptr);
  const std::filesystem::path folder =
      command.output.empty() ? std::filesystem::path(command.map.string() + "_overhead")
                             : command.output;
  const OverheadSummary made = make_overhead(map, pointers, folder, options, console.progress());
  store(command.map, made);
  console.say(std::to_string(made.columns) + " x " + std::to_string(made.rows) + " pixels of " +
              fixed(made.resolution_m, 3) + " m, " + fixed(made.covered_m2, 0) + " m^2 seen, " +
              std::to_string(made.images_used) + " images");
  console.say("overhead image: layer overhead of " + command.map.string() + "; " +
              made.image.string());
  console.result({{"columns", made.columns},
                  {"rows", made.rows},
                  {"resolution_m", made.resolution_m},
                  {"west_m", made.west_m},
                  {"north_m", made.north_m},
                  {"covered_m2", made.covered_m2},
                  {"views", made.views},
                  {"images_used", made.images_used},
                  {"images_missing", made.images_missing},
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
                    "folder of the GeoTIFFs; default MAP_overhead");
        options.add("--resolution-m", &o.resolution_m, "side of a pixel [m]").range = {0.002, 1.0};
        options.add("--max-range-m", &o.max_range_m, "farthest ground taken from a camera [m]")
            .range = {0.5, 100.0};
        options.add("--mode", &command->mode, "how images are averaged").choices = {"weighted",
                                                                                    "mean"};
        options.add("--keep-exposure", &command->keep_exposure, "do not balance exposure");
        options.add("--memory-mb", &o.memory_mb, "for tiles in work").range = {16, 1e6};
      },
      [command](Console& console, const CommonOptions& common) {
        return run(*command, console, common);
      }};
}

}  // namespace roadbook
