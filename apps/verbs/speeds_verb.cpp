#include <memory>

#include "apps/summaries/speeds_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb speeds_verb() {
  auto command = std::make_shared<SpeedsRequest>();
  return {"speeds", "computes where people are met and how fast to drive",
          [command](Options& options) {
            options.add("--map,-m", &command->map, "map file, after `roads`").required = true;
            options.add("--detections", &command->detections,
                        "tables of detected people, in the vehicle frame");
            options.add("--observed", &command->observed,
                        "session in which people were searched, even if none was found");
            options.add("--replace", &command->replace,
                        "replace earlier detections of the sessions in the tables");
            options.add("--local", &command->local, "solve only around new detections, to 1e-6");
            options.add("--truth", &command->truth,
                        "people, spaces and crossings from the truth of simulated drives");
            options
                .add("--days-later", &command->days_later,
                     "speed map for a later date [days], without new visits")
                .range = {0.0, 36500.0};
            options.add("--config", &command->config, "YAML file of priors, speeds and limits");
          },
          [command](Console& console, const CommonOptions&) {
            print_speeds(console, make_speeds(*command));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
