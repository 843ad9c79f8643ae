#include <memory>

#include "apps/map_task.hpp"
#include "apps/summaries/map_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "mapping/store/map_file_lock.hpp"

namespace roadbook {

namespace {

std::optional<SessionAdjust> session_adjust_from(const std::string& name) {
  if (name == "near") return SessionAdjust::kNear;
  if (name == "all") return SessionAdjust::kAll;
  if (name == "none") return SessionAdjust::kNone;
  return std::nullopt;
}

}  // namespace

Verb map_verb() {
  auto command = std::make_shared<MapRequest>();
  auto solver = std::make_shared<std::string>("own");
  auto adjust = std::make_shared<std::string>();
  auto task = std::make_shared<MapTask>();
  return {
      "map", "builds a map from one drive or several",
      [=](Options& options) {
        options.add("DRIVE", &command->drives, "recorded drives, oldest first");
        options.add("--map,-m", &command->map, "map file to write, or to extend").required = true;
        options.add("--model", &command->model, "YAML file of known effects, which are corrected");
        add_vehicle_option(options, &command->vehicle);
        options.add("--equal-rows", &command->equal_rows,
                    "use labelled rows of equal spaces as constraints");
        options.add("--solver", solver.get(), "solver of the bundle adjustment").choices = {
            "own", "ceres"};
        options.add("--apart", &command->options.gate.apart,
                    "keep parts that nothing joins as pieces of the map");
        options.add("--batch", &command->batch,
                    "build an existing map again from the recordings of all its drives");
        options.add("--adjust", adjust.get(), "what moves when a drive extends a map").choices = {
            "near", "all", "none"};
        options.add("--as", &command->options.session_name, "name of the session");
        options.add("--replace", &command->options.replace,
                    "build a map of these drives alone, replacing an existing one");
        add_task_options(options, *task);
        options.add("--seed", &command->options.seed, "seed of all random numbers");
      },
      [=](Console& console, const CommonOptions& common) {
        command->adjust = session_adjust_from(*adjust);
        command->options.num_threads = common.threads;
        if (run_map_task(console, *command, *task)) return ExitStatus::kDone;
        if (*solver == "ceres") command->options.bundle.bundle.solver = LeastSquaresSolver::kCeres;
        const MapHold hold(command->map);  // until the map also has the summary of this run
        print_map(console, map_drives(*command, console), command->map);
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
