#include <memory>

#include "apps/drive_option.hpp"
#include "apps/summaries/overhead_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb overhead_verb() {
  auto command = std::make_shared<OverheadRequest>();
  auto mode = std::make_shared<std::string>("weighted");
  auto keep_exposure = std::make_shared<bool>(false);
  return {
      "overhead", "makes the bird's-eye view (overhead image) of a map",
      [=](Options& options) {
        OverheadOptions& o = command->options;
        options.add("--map,-m", &command->map, "map file").required = true;
        options.add("--output,-o", &command->output,
                    "folder of the GeoTIFFs; default: MAP_overhead");
        add_drive_option(options, &command->drives);
        options.add("--resolution-m", &o.resolution_m, "side of a pixel [m]").range = {0.002, 1.0};
        options
            .add("--max-range-m", &o.max_range_m,
                 "farthest ground taken from a camera [m]; default: 8, more for cameras that see "
                 "no ground so near")
            .range = {0.5, 100.0};
        add_vehicle_option(options, &command->vehicle);
        options.add("--mode", mode.get(), "how images are averaged").choices = {"weighted", "mean"};
        options.add("--keep-exposure", keep_exposure.get(), "do not balance exposure");
        options
            .add("--memory-mb", &o.memory_mb, "memory for tiles and for decoded camera images [MB]")
            .range = {64, 1e6};
      },
      [=](Console& console, const CommonOptions& common) {
        command->options.num_threads = common.threads;
        command->options.mode = *mode == "mean" ? OverheadMode::kMean : OverheadMode::kWeighted;
        command->options.balance_exposure = !*keep_exposure;
        print_overhead(console, overhead_of_map(*command, console), command->map);
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
