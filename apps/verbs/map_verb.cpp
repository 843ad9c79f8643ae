#include <memory>

#include "apps/summaries/map_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb map_verb() {
  auto command = std::make_shared<MapRequest>();
  auto solver = std::make_shared<std::string>("own");
  return {"map", "builds a map from one drive or several",
          [=](Options& options) {
            options.add("DRIVE", &command->drives, "recorded drives, oldest first").required = true;
            options.add("--map,-m", &command->map, "map file to write, or to extend").required =
                true;
            options.add("--model", &command->model, "YAML file of imperfections that are known");
            add_vehicle_option(options, &command->vehicle);
            options.add("--equal-rows", &command->equal_rows,
                        "labelled rows of equal spaces straighten the map");
            options.add("--solver", solver.get(), "of the bundle adjustment").choices = {"own",
                                                                                         "ceres"};
            options.add("--replace", &command->options.replace,
                        "a map of these drives alone, whatever is there");
            options.add("--seed", &command->options.seed, "of everything drawn by chance");
          },
          [=](Console& console, const CommonOptions& common) {
            command->options.num_threads = common.threads;
            if (*solver == "ceres")
              command->options.bundle.bundle.solver = LeastSquaresSolver::kCeres;
            print_map(console, map_drives(*command, console), command->map);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
