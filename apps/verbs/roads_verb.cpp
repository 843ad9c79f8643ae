#include <memory>

#include "apps/summaries/roads_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb roads_verb() {
  auto command = std::make_shared<RoadsRequest>();
  return {
      "roads", "finds lanes and intersections of a map",
      [command](Options& options) {
        RoadNetworkOptions& o = command->options;
        options.add("--map,-m", &command->map, "map file").required = true;
        options
            .add("--reach-m", &o.reach_m,
                 "distance below which driven lines are one lane [m]; 0: from the data")
            .range = {0.0, 100.0};
        options.add("--min-passes", &o.min_passes, "leave out places with fewer passes").range = {
            1, 1000};
        options
            .add("--vehicle-width-m", &command->vehicle_width_m,
                 "of the recording vehicle, for the width of the lanes; default: as the map "
                 "knows it, else 1.9")
            .range = {0.1, 10.0};
      },
      [command](Console& console, const CommonOptions& common) {
        command->num_threads = common.threads;
        print_roads(console, find_roads(*command, console), command->paths.max_deviation_m);
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
